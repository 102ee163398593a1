// A camera's path, and what is written of it.
#pragma once

#include "align/camera_path.hpp"
#include "align/seen_area.hpp"
#include "sheet/camera_chart.hpp"
