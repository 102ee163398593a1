// Captures: their format, times and blocks, and the files that hold them.
#pragma once

#include "capture/noise_file.hpp"
#include "capture/picture.hpp"
#include "capture/timeline.hpp"
#include "imev/capture_source.hpp"
#include "imev/each_block.hpp"
#include "imev/expected_values.hpp"
#include "tik/header.hpp"
#include "tik/reader.hpp"
#include "tik/recovery.hpp"
