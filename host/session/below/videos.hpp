// Video files.
#pragma once

#include "media/frame_queue.hpp"
#include "media/video_writer.hpp"
