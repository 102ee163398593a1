// Gain functions and masks, hard and soft: their files, and what is wrong with them.
#pragma once

#include "capture/source_text.hpp"
#include "exposure/corridor_fit.hpp"
#include "exposure/function_check.hpp"
#include "exposure/function_diagnostics.hpp"
#include "exposure/function_file.hpp"
#include "exposure/function_numbers.hpp"
#include "exposure/function_text.hpp"
#include "exposure/mask.hpp"
#include "exposure/mask_check.hpp"
#include "exposure/normalization.hpp"
#include "exposure/shutter_shape.hpp"
#include "mask/feather.hpp"
#include "mask/layers.hpp"
#include "render/render_plan.hpp"
