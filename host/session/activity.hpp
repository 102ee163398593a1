// What changes in a capture, when and where.
#pragma once

#include "imev/activity.hpp"
#include "imev/activity_moments.hpp"
#include "sheet/activity_chart.hpp"
#include "sheet/activity_map.hpp"
