// What the engine throws.
#pragma once

#include "capture/error.hpp"
