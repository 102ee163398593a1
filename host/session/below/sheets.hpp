// Pictures of pictures: contact sheets, overlays, and graphs to draw beside them.
#pragma once

#include "plot/canvas.hpp"
#include "plot/graph.hpp"
#include "sheet/contact_sheet.hpp"
#include "sheet/drawings.hpp"
