// format(), as the standard library has it.
#pragma once

#include "capture/format.hpp"
