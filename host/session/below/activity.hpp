// What changes in a capture, when and where.
#pragma once

#include "sheet/activity_chart.hpp"
