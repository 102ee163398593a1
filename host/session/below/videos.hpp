// Video files.
#pragma once

#include "media/frame_queue.hpp"
#include "media/writers/video_writer.hpp"
