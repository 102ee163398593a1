// All that an application needs: sessions, the requests they answer, and what comes of them.
//
//   nutik::SourceRequest source;
//   source.path = "clip.tik";
//   nutik::Session session(source);
//   nutik::ExposureRequest request;
//   request.gains = nutik::PlainInterval{nutik::StatedTime::parse("10ms", "length"), nutik::Shutter()};
//   nutik::write_picture("picture.png", session.render(request, {}).picture);
#pragma once

#include "session/activity.hpp"
#include "session/capture.hpp"
#include "session/capture_figures.hpp"
#include "session/computing_request.hpp"
#include "session/contact_request.hpp"
#include "session/encoding.hpp"
#include "session/error.hpp"
#include "session/exposure_request.hpp"
#include "session/frames_request.hpp"
#include "session/function_input.hpp"
#include "session/functions.hpp"
#include "session/mask_making.hpp"
#include "session/measured_noise.hpp"
#include "session/own_exposure.hpp"
#include "session/picture_queue.hpp"
#include "session/pictures.hpp"
#include "session/series_making.hpp"
#include "session/series_request.hpp"
#include "session/session.hpp"
#include "session/shared_warnings.hpp"
#include "session/sheet_making.hpp"
#include "session/sheets.hpp"
#include "session/sweep_request.hpp"
#include "session/video_making.hpp"
#include "session/videos.hpp"
