// Regions of a picture: shapes, and what is made of them.
#pragma once

#include "mask/distance.hpp"
#include "mask/region.hpp"
