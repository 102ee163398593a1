#include "features/study/study_shot.hpp"

#include <algorithm>
#include <stdexcept>
#include <utility>

#include "align/alignment.hpp"
#include "capture/format.hpp"
#include "features/masks/mask_making.hpp"
#include "features/plate/plate.hpp"
#include "imev/each_block.hpp"

namespace nutik {
namespace {

// Regions are grown and softened: a smaller motion hides in that.
constexpr double kMaxCameraPixels = 4;
// Shorter shots show nothing that goes anywhere.
constexpr std::uint64_t kMinSamples = 8;

MemoryNeeds study_needs(const CaptureFormat& capture) {
  MemoryNeeds needs = mask_making_needs(capture);
  needs.add(plate_making_needs(capture));
  needs.add(camera_check_needs(capture));
  return needs;
}

std::string starts_of(const std::vector<SampleRange>& shots) {
  std::string text;
  for (const SampleRange& shot : shots) {
    text += format("{}{}{}", text.empty() ? "" : ", ", shot.first, shot.size() == 1 ? " (a single one)" : "");
  }
  return text;
}

ClipMoment picture(std::uint64_t number) { return {static_cast<std::int64_t>(number), true}; }

class ShotPlanner {
 public:
  ShotPlanner(const StudyRequest& request, const StudyTerms& terms, std::string name)
      : request_(request), terms_(terms), name_(std::move(name)) {}

  // What rendering takes at the end is there, or is said to be missing before the work begins.
  [[nodiscard]] Session open(const SourceRequest& source) const {
    constexpr std::uint64_t kDefaultFunctions = 8;
    Session session(source, terms_.devices, {.progress = progress("reading"), .besides = study_needs});
    const CaptureFormat& format = session.format();
    MemoryNeeds needs = study_needs(format);
    needs.add(rendering_needs(format, output_format(terms_.output, format).type, kDefaultFunctions,
                              kDefaultBlockSamples));
    needs.add("a block", largest_block(session.capture()));
    needs.rest_of(session.devices().request().memory.bytes);
    return session;
  }

  // Of a single shot. Where the camera moved, a clip is read once more; also where everything seems to move, for a subject
  // that fills much of the first picture hides that.
  [[nodiscard]] PlannedStudy plan(const SourceRequest& source, Session session) const {
    const bool may_align = session.is_clip() && !source.align;
    const std::uint64_t samples = session.timeline().sample_count();
    std::optional<MovedCamera> moved = moved_camera(session.capture());
    if (moved && moved->pixels > kMaxCameraPixels) {
      if (!session.is_clip()) {
        throw EverythingMoves(
            format("{}: {}. A study needs pictures that lie on each other: encode the clip again", name_,
                   moved->text()));
      }
      if (may_align) return plan_aligned(source, samples);
    }
    check_alignment(session.capture());
    try {
      return plan_as_it_is(std::move(session), std::move(moved));
    } catch (const EverythingMoves&) {
      if (!may_align) throw;
      try {
        return plan_aligned(source, samples);
      } catch (const CannotAlign&) {
      }
      throw;
    }
  }

 private:
  [[nodiscard]] ReportedProgress progress(const std::string& what) const {
    return terms_.progress ? terms_.progress(what) : ReportedProgress();
  }

  // Near and far things cannot be aligned together: near ones would be taken for what moves.
  void check_alignment(tik::Reader& capture) const {
    const std::optional<tik::Alignment>& aligned = capture.header().alignment;
    const bool looks_for_subject = request_.style != StudyStyle::slit &&
                                   request_.style != StudyStyle::clean &&
                                   std::holds_alternative<std::uint32_t>(request_.moments);
    const double most = min_misplaced_pixels(capture.format().shape);
    if (!aligned || !looks_for_subject || aligned->residual_pixels < most) return;
    throw NoSubject(format(
        "{}: one motion of the camera does not explain the pictures: moved back, half of the "
        "texture of one lies {:.2f} pixels or more from its place, and from {:.1f} on it is taken for what "
        "moves. Near things move against far ones where a camera is carried on. Film from one place, take a "
        "shorter part of the time, or name the moments to show",
        name_, aligned->residual_pixels, most));
  }

  // A region is stated in pixels of a clip that nobody knew to be cropped.
  void check_regions(const Shape& aligned) const {
    for (const Rectangle& region : request_.regions) {
      if (region.lies_in(aligned)) continue;
      throw UsageError(format(
          "region {},{},{},{} does not lie in the {} x {} pixels that every picture of {} saw: the camera moved, so "
          "the pictures are moved onto each other and cropped to these, and regions are taken of the result",
          region.x, region.y, region.width, region.height, aligned.width, aligned.height, name_));
    }
  }

  [[nodiscard]] PlannedStudy plan_as_it_is(Session session, std::optional<MovedCamera> moved) const {
    Study study = plan_study(session.capture(), name_, request_, terms_.devices->request().memory,
                             progress("looking for the subject"));
    return {std::move(session), std::move(study), std::move(moved)};
  }

  // With its pictures moved onto the first one, or the one in the middle where that shows too little of what the others
  // do.
  [[nodiscard]] PlannedStudy plan_aligned(const SourceRequest& source, std::uint64_t samples) const {
    SourceRequest aligned = source;
    for (const std::uint64_t reference : {std::uint64_t{0}, samples / 2}) {
      aligned.align.emplace();
      aligned.align->motion = kStudyMotion;
      aligned.align->reference = StatedTime::of_pictures(static_cast<std::int64_t>(reference));
      std::optional<Session> session;
      try {
        session.emplace(open(aligned));
      } catch (const CannotAlign&) {
        if (reference == samples / 2) throw;
        continue;
      }
      check_regions(session->format().shape);
      check_alignment(session->capture());
      try {
        PlannedStudy planned = plan_as_it_is(std::move(*session), {});
        planned.aligned_to = reference;
        return planned;
      } catch (const NoSubject& none) {
        throw NoSubject(
            format("{}. The camera may have moved: the pictures were moved back by their texture, and one that repeats "
                   "itself tells too little of that",
                   none.what()));
      }
    }
    throw std::logic_error("no picture was aligned to");
  }

  const StudyRequest& request_;
  const StudyTerms& terms_;
  std::string name_;  // for messages
};

}  // namespace

PlannedStudy plan_study(const SourceRequest& source, const StudyRequest& request, const StudyTerms& terms) {
  check_study(request);
  const std::string name = source.path.string();
  const ShotPlanner planner(request, terms, name);
  std::vector<SampleRange> shots;
  {
    Session session = planner.open(source);
    shots = shots_of(session.capture());
    if (shots.size() == 1) return planner.plan(source, std::move(session));
    if (!session.is_clip() || source.clip.from || source.clip.to) {
      throw InputError(
          format("{}: it has {} shots, which begin at pictures {}. A study shows a single one: take that "
                 "from the clip",
                 name, shots.size(), starts_of(shots)),
          {Setting::from, Setting::to});
    }
  }
  const std::string starts = starts_of(shots);
  const std::size_t count = shots.size();
  std::erase_if(shots, [](const SampleRange& shot) { return shot.size() < kMinSamples; });
  std::ranges::stable_sort(shots, std::ranges::greater(), &SampleRange::size);
  std::string reasons;
  for (const SampleRange& shot : shots) {
    SourceRequest of_shot = source;
    of_shot.clip.from = picture(shot.first);
    of_shot.clip.to = picture(shot.last);
    try {
      PlannedStudy planned = planner.plan(of_shot, planner.open(of_shot));
      planned.shot = shot;
      planned.notes.emplace_back(
          format("the clip has {} shots, which begin at pictures {}: of the longest that makes a study, "
                 "pictures {} … {} were taken",
                 count, starts, shot.first, shot.last - 1),
          std::vector{Setting::from, Setting::to});
      return planned;
    } catch (const InputError& reason) {
      const std::string_view text = reason.what();
      const std::string named = name + ": ";
      reasons += format("\n  {} … {}: {}", shot.first, shot.last - 1,
                        text.starts_with(named) ? text.substr(named.size()) : text);
    }
  }
  throw InputError(format("{}: none of its {} shots, which begin at pictures {}, makes a study:{}", name,
                          count, starts, reasons));
}

}  // namespace nutik
