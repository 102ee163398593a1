// Pictures of pictures: contact sheets, overlays, and graphs to draw beside them.
#pragma once

#include "plot/canvas.hpp"
#include "plot/graph.hpp"
#include "plot/ticks.hpp"
#include "sheet/contact_sheet.hpp"
#include "sheet/mask_overlay.hpp"
#include "sheet/thumbnail.hpp"
