// All that an application needs: sessions, the requests they answer, and what comes of them.
//
//   nutik::SourceRequest source;
//   source.path = "clip.tik";
//   nutik::Session session(source);
//   nutik::ExposureRequest request;
//   request.gains = nutik::PlainInterval{nutik::StatedTime::parse("10ms", "length"), nutik::Shutter()};
//   nutik::write_picture("picture.png", session.render(request, {}).picture);
#pragma once

#include "align/alignment.hpp"
#include "features/activity/activity.hpp"
#include "features/captures/capture_figures.hpp"
#include "features/captures/joining.hpp"
#include "features/captures/retiming.hpp"
#include "features/check/input_check.hpp"
#include "features/film/film_making.hpp"
#include "features/film/film_request.hpp"
#include "features/masks/mask_making.hpp"
#include "features/masks/mask_request.hpp"
#include "features/plate/plate.hpp"
#include "features/recipe/picture_recipe.hpp"
#include "features/series/picture_queue.hpp"
#include "features/series/series_making.hpp"
#include "features/series/series_request.hpp"
#include "features/sheets/sheet_request.hpp"
#include "features/solve/solving.hpp"
#include "features/solve/wish.hpp"
#include "features/study/study.hpp"
#include "features/study/study_shot.hpp"
#include "session/clips/encoding.hpp"
#include "session/clips/measured_noise.hpp"
#include "session/devices.hpp"
#include "session/live/live_pictures.hpp"
#include "session/live/session_of_part.hpp"
#include "session/output_check.hpp"
#include "session/requests/exposure_request.hpp"
#include "session/requests/named_inputs.hpp"
#include "session/requests/output_request.hpp"
#include "session/requests/source_request.hpp"
#include "session/requests/stated_moments.hpp"
#include "session/session.hpp"
#include "session/text/number_text.hpp"
#include "session/text/shared_warnings.hpp"
#include "session/text/shell_text.hpp"
#include "session/trace_picture.hpp"
