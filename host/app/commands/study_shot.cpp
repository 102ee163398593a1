#include "app/commands/study_shot.hpp"

#include <algorithm>
#include <utility>

#include "app/commands/opened_session.hpp"
#include "app/output/progress.hpp"
#include "app/requests/requests.hpp"
#include "session/below/capture.hpp"
#include "session/below/error.hpp"
#include "session/below/format.hpp"
#include "session/clips/alignment.hpp"
#include "session/making/mask_making.hpp"
#include "session/making/plate_request.hpp"

namespace nutik::app {
namespace {

// What regions are grown by, and the soft edge of them: less hides in these.
constexpr double kMostCameraPixels = 4;
// Shorter shots show nothing that goes anywhere.
constexpr std::uint64_t kLeastSamples = 8;

MemoryNeeds study_needs(const CaptureFormat& capture) {
  MemoryNeeds needs = mask_making_needs(capture);
  needs.add(plate_making_needs(capture));
  needs.add(camera_check_needs(capture));
  return needs;
}

// What rendering takes at the end is there, or is said to be missing before the work begins.
Session open_whole(const Options& options) {
  constexpr std::uint64_t kUsualFunctions = 8;
  Session session = open_session(options, {.besides = study_needs});
  const CaptureFormat& format = session.format();
  MemoryNeeds needs = study_needs(format);
  needs.add(rendering_needs(format, output_format(output_request(options), format).type, kUsualFunctions,
                            kDefaultBlockSamples));
  needs.add("a block", largest_block(session.capture()));
  needs.rest_of(session.devices().request().memory.bytes);
  return session;
}

// With its pictures moved onto the first one, or the one in the middle where that shows too little of what the others do.
Session open_aligned(Options& options, std::uint64_t samples) {
  options.align = "homography";
  try {
    return open_whole(options);
  } catch (const CannotAlign&) {
    if (options.align_to) throw;
    options.align_to = format("{}f", samples / 2);
    return open_whole(options);
  }
}

PlannedStudy planned(Session session, const Options& options, const StudyRequest& request,
                     std::optional<MovedCamera> moved) {
  Study study = nutik::plan_study(session.capture(), options.operands.front(), request,
                                  session.devices().request().memory,
                                  progress_bar("looking for the subject", options.quiet));
  return {std::move(session), std::move(study), std::move(moved)};
}

// Of a single shot. Where the camera moved, a clip is read once more; also where everything seems to move, for a subject
// that fills much of the first picture hides that.
PlannedStudy plan_still(Options& options, const StudyRequest& request, Session session) {
  const bool may_align = session.is_clip() && !options.align;
  const std::uint64_t samples = session.timeline().sample_count();
  std::optional<MovedCamera> moved = moved_camera(session.capture());
  if (moved && moved->pixels > kMostCameraPixels) {
    if (!session.is_clip()) {
      throw InputError(
          format("{}: {}. A study needs a camera that stands still: encode the clip again with "
                 "--align rigid",
                 options.operands.front(), moved->text()));
    }
    if (may_align) return planned(open_aligned(options, samples), options, request, {});
  }
  try {
    return planned(std::move(session), options, request, std::move(moved));
  } catch (const EverythingMoves&) {
    if (!may_align) throw;
    const Options before = options;
    try {
      return planned(open_aligned(options, samples), options, request, {});
    } catch (const CannotAlign&) {
      options = before;
    }
    throw;
  }
}

std::string starts_of(const std::vector<SampleRange>& shots) {
  std::string text;
  for (const SampleRange& shot : shots) text += format("{}{}", text.empty() ? "" : ", ", shot.first);
  return text;
}

}  // namespace

PlannedStudy plan_study(Options& options, const StudyRequest& request) {
  std::vector<SampleRange> shots;
  const std::string name = options.operands.front();
  {
    Session session = open_whole(options);
    shots = shots_of(session.capture());
    if (shots.size() == 1) return plan_still(options, request, std::move(session));
    if (!session.is_clip() || options.clip_from || options.clip_to) {
      throw InputError(
          format("{}: it has {} shots, which begin at pictures {}. A study shows a single one: take that "
                 "with --from and --to from the clip",
                 name, shots.size(), starts_of(shots)));
    }
  }
  const std::string starts = starts_of(shots);
  const std::size_t count = shots.size();
  std::erase_if(shots, [](const SampleRange& shot) { return shot.size() < kLeastSamples; });
  std::ranges::stable_sort(shots, std::ranges::greater(), &SampleRange::size);
  std::string reasons;
  for (const SampleRange& shot : shots) {
    Options of_shot = options;
    of_shot.clip_from = format("{}f", shot.first);
    of_shot.clip_to = format("{}f", shot.last);
    try {
      PlannedStudy planned = plan_still(of_shot, request, open_whole(of_shot));
      planned.study.notes.push_back(format(
          "the clip has {} shots, which begin at pictures {}: of the longest that makes a study, pictures "
          "{} … {} were taken; --from and --to take others",
          count, starts, shot.first, shot.last - 1));
      options = std::move(of_shot);
      return planned;
    } catch (const InputError& reason) {
      reasons += format("\n  {} … {}: {}", shot.first, shot.last - 1, reason.what());
    }
  }
  throw InputError(format("{}: none of its {} shots, which begin at pictures {}, makes a study:{}", name,
                          count, starts, reasons));
}

}  // namespace nutik::app
