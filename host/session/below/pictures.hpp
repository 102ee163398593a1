// Picture files, and what they carry.
#pragma once

#include "media/input_checksum.hpp"
#include "media/stills/mask_reader.hpp"
#include "media/stills/netpbm.hpp"
#include "media/formats/numbered_name.hpp"
#include "media/stills/picture_text.hpp"
#include "media/writers/picture_writer.hpp"
#include "media/writers/recipe.hpp"
#include "media/stills/still_sequence.hpp"
