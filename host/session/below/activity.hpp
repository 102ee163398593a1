// What changes in a capture, when and where.
#pragma once

#include "session/making/activity_request.hpp"
#include "sheet/drawings.hpp"
