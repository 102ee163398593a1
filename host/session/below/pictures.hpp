// Picture files, and what they carry.
#pragma once

#include "media/input_checksum.hpp"
#include "media/mask_reader.hpp"
#include "media/netpbm.hpp"
#include "media/numbered_name.hpp"
#include "media/picture_text.hpp"
#include "media/picture_writer.hpp"
#include "media/recipe.hpp"
#include "media/still_sequence.hpp"
