#include "features/study/study_shot.hpp"

#include <algorithm>
#include <exception>
#include <numeric>
#include <stdexcept>
#include <utility>

#include "align/alignment.hpp"
#include "capture/format.hpp"
#include "capture/median.hpp"
#include "features/masks/mask_making.hpp"
#include "features/plate/plate.hpp"
#include "imev/each_block.hpp"
#include "media/clip.hpp"
#include "session/clips/clip_source.hpp"

namespace nutik {
namespace {

// Regions are grown and softened: a smaller motion hides in that.
constexpr double kMaxCameraPixels = 4;
// From one picture to the next: less lies within a border that is blended usually.
constexpr double kGhostPixels = 4;
// As a share of a subject's size: nearer copies of it are hardly told from each other.
constexpr double kGhostShare = 0.25;
// Copies lie apart that are a subject's size from each other: worse than what is made between them may be, where ground
// with texture goes along with what moves over it.
constexpr double kApart = 1;

MemoryNeeds study_needs(const CaptureFormat& capture) {
  MemoryNeeds needs = mask_making_needs(capture);
  needs.add(plate_making_needs(capture));
  needs.add(camera_check_needs(capture));
  return needs;
}

ClipMoment picture(std::uint64_t number) { return {static_cast<std::int64_t>(number), true}; }

// What the first pictures of a clip tell before all of it is read.
struct Beginning {
  // So many are darker than those behind them. All are exposed as the first one, which shall be none of these.
  std::uint64_t dark = 0;
  bool moves = false;     // the camera surely moves
  bool is_other = false;  // most of what they show is another scene than the first one's
};

Beginning beginning_of(const SourceRequest& source, bool looks_for_dark) {
  constexpr std::uint64_t kLookedAt = 96, kCompared = 24;
  constexpr double kDark = 0.75, kBright = 0.97;  // of the mean code of most
  Beginning beginning;
  refuse_streams(source.path);
  const std::unique_ptr<Clip> clip = open_clip(source.path, source.clip);
  const CaptureFormat& format = clip->info().format;
  std::vector<std::byte> raster(format.sample_bytes());
  std::vector<double> means;
  CameraLooks camera(format);
  const auto looks_for_motion = [&] { return !beginning.moves && !source.align; };
  while (means.size() < kLookedAt && (looks_for_dark || looks_for_motion()) && clip->read(raster)) {
    if (looks_for_motion() && means.size() % kCompared == 0) {
      const std::optional<MovedCamera>& moved = camera.look(means.size(), raster);
      beginning.moves = moved && moved->pixels > kMaxCameraPixels;
    }
    means.push_back(with_codes(format.code_bytes, raster.data(), [&](const auto* codes) {
      return static_cast<double>(std::accumulate(codes, codes + format.shape.value_count(), std::uint64_t{0}));
    }));
  }
  if (means.empty() || !looks_for_dark) return beginning;
  const double usual = median(means);
  if (means.front() >= kDark * usual) return beginning;
  const auto bright = std::ranges::find_if(means, [&](double mean) { return mean >= kBright * usual; });
  beginning.dark = static_cast<std::uint64_t>(bright - means.begin());
  beginning.is_other = camera.moved() && camera.moved()->is_untold();
  return beginning;
}

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

  // Plans one of the clip's shots, or a scene of it.
  [[nodiscard]] PlannedStudy plan_shot(const SourceRequest& source, SampleRange shot) const {
    const Beginning beginning = beginning_of(part_of(source, shot), source.deflickered);
    return or_scene(source, shot, beginning.is_other, [&] { return plan_bright(source, shot, beginning); });
  }

  // What plan_all() makes of a shot. If nothing rests in that, or its dark beginning shows another scene, its pictures
  // may be those of several scenes that no cut parts: then the longest of them that makes a study. Moments that were
  // stated are those of all of it.
  [[nodiscard]] PlannedStudy or_scene(const SourceRequest& source, SampleRange shot, bool has_several,
                                      const std::function<PlannedStudy()>& plan_all) const {
    if (!std::holds_alternative<std::uint32_t>(request_.moments)) return plan_all();
    std::optional<PlannedStudy> planned;
    std::exception_ptr refusal;
    const auto try_all = [&] {
      try {
        planned.emplace(plan_all());
      } catch (const EverythingMoves&) {
        refusal = std::current_exception();
      }
    };
    if (!has_several) try_all();
    if (planned && planned->study.moving_share <= kMaxMoving) return std::move(*planned);
    std::optional<PlannedStudy> scene;
    for (const SampleRange& each : scenes_of(source, shot)) {
      if (scene && !scene->study.falls_short) break;
      try {
        PlannedStudy made = plan_bright(source, each, beginning_of(part_of(source, each), source.deflickered));
        const bool is_enough = kMinOfSamples * made.part->size() >= shot.size();
        if (is_enough && made.study.moving_share <= kMaxMoving && (!scene || !made.study.falls_short))
          scene = std::move(made);
      } catch (const Error& error) {
        if (!is_refusal(error)) throw;
      }
    }
    if (scene) {
      scene->notes.emplace_back(
          format("pictures {} … {} were taken, the longest part that shows one scene and makes a study: the others "
                 "cannot be moved onto these, as behind or within a dissolve or a wipe",
                 scene->part->first, scene->part->last - 1),
          std::vector{Setting::from, Setting::to});
      return std::move(*scene);
    }
    if (!planned && !refusal) try_all();
    if (refusal) std::rethrow_exception(refusal);
    return std::move(*planned);
  }

  // Plans what the camera moved in, without reading it as it was filmed. Nothing where it is no single shot that can be
  // moved onto the first picture.
  [[nodiscard]] std::optional<PlannedStudy> plan_moved(const SourceRequest& source) const {
    try {
      Session session = open(aligned_to(0, source));
      if (shots_of(session.capture()).size() != 1) return std::nullopt;
      return planned(std::move(session), 0);
    } catch (const CannotAlign&) {
      return std::nullopt;
    }
  }

  // Plans a single shot. Where the camera moved or seems to, a clip is read once more; also where everything seems to
  // move, for a subject that fills much of the first picture hides that. Where no motion of the camera explains the
  // pictures, they are shown as they were filmed, or as they were moved, whichever rests more.
  [[nodiscard]] PlannedStudy plan(const SourceRequest& source, Session session) const {
    const bool may_align = session.is_clip() && !source.align;
    std::optional<MovedCamera> moved = moved_camera(session.capture());
    const bool is_still = !moved || moved->pixels <= kMaxCameraPixels;
    if (!is_still && !session.is_clip()) {
      throw EverythingMoves(
          format("{}: {}. A study needs pictures that lie on each other: encode the clip again", name_, moved->text()));
    }
    std::optional<Study> study;
    if (is_still || !may_align) {
      try {
        study.emplace(study_of(session, may_align ? Unrest::refused : Unrest::shown));
      } catch (const EverythingMoves&) {
        if (!may_align) throw;
      }
    }
    std::vector<Note> notes;
    if (study) {
      if (std::optional<Note> note = unexplained(session.capture())) {
        study->falls_short = true;
        notes.push_back(std::move(*note));
      }
      if (may_align && moved && moved->seemingly_pixels > kMaxCameraPixels) {
        std::string why;
        std::optional<PlannedStudy> aligned = plan_aligned(source, session.timeline().sample_count(), why);
        const bool is_whole = aligned && !aligned->part;
        const bool has_moved =
            aligned && aligned->session.capture().header().alignment->moved_pixels > kMaxCameraPixels;
        if (has_moved && aligned->study.moving_share < study->moving_share) return std::move(*aligned);
        if (is_whole && !has_moved) moved.reset();  // every picture was found where the first one is
      }
      return {std::move(session), std::move(*study), std::move(moved), std::move(notes)};
    }
    std::string reason;
    std::optional<PlannedStudy> aligned = plan_aligned(source, session.timeline().sample_count(), reason);
    if (aligned && (aligned->notes.empty() || !is_still)) return std::move(*aligned);
    if (!is_still) throw EverythingMoves(reason);
    try {
      study.emplace(study_of(session, Unrest::shown));
    } catch (const EverythingMoves&) {
      if (aligned) return std::move(*aligned);
      throw;
    }
    if (aligned && aligned->study.moving_share < study->moving_share) return std::move(*aligned);
    notes.emplace_back(format(
        "no motion of the camera explains the pictures, of which {:.0f} % differ from the scene at rest on average: "
        "they are shown as they were filmed, and what rests in them may be soft",
        100 * study->moving_share));
    return {std::move(session), std::move(*study), std::move(moved), std::move(notes)};
  }

 private:
  [[nodiscard]] static SourceRequest part_of(SourceRequest source, SampleRange part) {
    source.clip.from = picture(part.first);
    source.clip.to = picture(part.last);
    return source;
  }

  // Plans a shot without the dark beginning that it may have.
  [[nodiscard]] PlannedStudy plan_bright(const SourceRequest& clip, SampleRange shot,
                                         const Beginning& beginning) const {
    const bool is_without = beginning.dark > 0 && shot.size() >= beginning.dark + kMinSamples;
    const SampleRange part{shot.first + (is_without ? beginning.dark : 0), shot.last};
    const SourceRequest source = part_of(clip, part);
    std::optional<PlannedStudy> moved = beginning.moves ? plan_moved(source) : std::nullopt;
    PlannedStudy planned = moved ? std::move(*moved) : plan(source, open(source));
    if (!planned.part) planned.part = part;
    if (is_without) {
      planned.notes.emplace_back(format("the first pictures are darker than most behind them, and those before {} were "
                                        "left out: all others are exposed as the first one",
                                        part.first),
                                 std::vector{Setting::from});
    }
    return planned;
  }

  [[nodiscard]] ReportedProgress progress(const std::string& what) const {
    return terms_.progress ? terms_.progress(what) : ReportedProgress();
  }

  // Near and far things cannot be aligned together: near ones would be taken for what moves.
  [[nodiscard]] std::optional<Note> unexplained(tik::Reader& capture) const {
    const std::optional<tik::Alignment>& aligned = capture.header().alignment;
    const bool looks_for_subject = request_.style != StudyStyle::slit &&
                                   request_.style != StudyStyle::clean &&
                                   std::holds_alternative<std::uint32_t>(request_.moments);
    const double most = min_misplaced_pixels(capture.format().shape);
    if (!aligned || !looks_for_subject || aligned->residual_pixels.value_or(0) < most) return std::nullopt;
    return Note(format(
        "one motion of the camera does not explain the pictures: moved back, half of a picture's texture is still "
        "{:.2f} pixels or more off, and from {:.1f} on that is taken for what moves. Where a camera is carried on, "
        "near things move against far ones. Film from one place, take a shorter part of the time, or name the moments "
        "to show",
        *aligned->residual_pixels, most), {Setting::from, Setting::to});
  }

  // Regions were stated in pixels of the clip; aligned pictures are cropped, and a region may lie outside of them.
  void check_regions(const Shape& aligned) const {
    for (const Rectangle& region : request_.regions) {
      if (region.lies_in(aligned)) continue;
      throw UsageError(format(
          "region {},{},{},{} does not lie in the {} x {} pixels that every picture of {} saw: the camera moved, so "
          "the pictures are moved onto each other and cropped to these, and regions are taken of the result",
          region.x, region.y, region.width, region.height, aligned.width, aligned.height, name_));
    }
  }

  [[nodiscard]] Study study_of(Session& session, Unrest unrest) const {
    return plan_study(session.capture(), name_, request_, terms_.devices->request().memory,
                      progress("looking for the subject"), unrest);
  }

  [[nodiscard]] static SourceRequest aligned_to(std::uint64_t reference, SourceRequest source,
                                                CameraMotion motion = kStudyMotion) {
    source.align.emplace();
    source.align->motion = motion;
    source.align->reference = StatedTime::of_pictures(static_cast<std::int64_t>(reference));
    return source;
  }

  // Plans aligned pictures.
  [[nodiscard]] PlannedStudy planned(Session session, std::uint64_t reference) const {
    check_regions(session.format().shape);
    Study study = study_of(session, Unrest::shown);
    PlannedStudy planned{std::move(session), std::move(study), {}};
    if (std::optional<Note> note = unexplained(planned.session.capture())) planned.notes.push_back(std::move(*note));
    planned.study.falls_short = planned.study.falls_short || !planned.notes.empty();
    planned.aligned_to = reference;
    return planned;
  }

  // Moves the pictures onto the first one; onto the one in the middle if the first shows too little of what the others
  // show. If a picture cannot be moved, those before it or behind it are taken, whichever are more. Nothing if most
  // cannot be moved: `reason` says why.
  [[nodiscard]] std::optional<PlannedStudy> plan_aligned(const SourceRequest& source, std::uint64_t samples,
                                                         std::string& reason) const {
    constexpr int kMaxTries = 6;
    const bool has_parts = !source.clip.from || source.clip.from->is_picture;
    const std::uint64_t first = source.clip.from ? static_cast<std::uint64_t>(source.clip.from->value) : 0;
    SampleRange part{0, samples};
    std::uint64_t reference = 0;
    CameraMotion motion = kStudyMotion;
    for (int tries = 0; tries < kMaxTries; ++tries) {
      SourceRequest aligned = aligned_to(reference - part.first, source, motion);
      const bool is_part = part.size() < samples;
      if (is_part) {
        aligned.clip.from = picture(first + part.first);
        aligned.clip.to = picture(first + part.last);
      }
      try {
        PlannedStudy study = planned(open(aligned), reference - part.first);
        if (is_part) {
          study.notes.emplace_back(format("pictures {} … {} were taken, for others cannot be moved onto these: {}",
                                          first + part.first, first + part.last - 1, reason),
                                   std::vector{Setting::from, Setting::to});
          study.study.falls_short = true;
          study.part = SampleRange{first + part.first, first + part.last};
        }
        return study;
      } catch (const CannotAlign& error) {
        if (reason.empty()) reason = error.what();
        motion = error.motion;  // by which most pictures were found
        const std::uint64_t failed = part.first + error.picture.value_or(0);
        if (error.picture && failed > reference && 2 * (failed - part.first) >= part.size()) {
          part.last = failed;
        } else if (reference == 0 && part.size() == samples) {
          reference = samples / 2;
          continue;
        } else if (error.picture && failed < reference) {
          // Where one is not enough, half of those up to the reference.
          const bool is_second = failed > 0 && failed == part.first;
          part.first = failed + (is_second ? std::max<std::uint64_t>((reference - failed) / 2, 1) : 1);
        } else if (error.picture) {
          part.last = failed;
        } else {
          return std::nullopt;
        }
        if (!has_parts || part.size() < std::max(kMinSamples, samples / kMinOfSamples)) return std::nullopt;
      }
    }
    return std::nullopt;
  }

  const StudyRequest& request_;
  const StudyTerms& terms_;
  std::string name_;  // for messages
};

PlannedStudy plan_filmed(const SourceRequest& source, const StudyRequest& request, const StudyTerms& terms) {
  const std::string name = source.path.string();
  const ShotPlanner planner(request, terms, name);
  const bool is_part = source.clip.from || source.clip.to;
  const Beginning beginning =
      is_tik(source.path) ? Beginning() : beginning_of(source, source.deflickered && !is_part);
  if (beginning.moves && beginning.dark == 0) {
    if (std::optional<PlannedStudy> moved = planner.plan_moved(source)) return std::move(*moved);
  }
  std::vector<SampleRange> shots;
  {
    Session session = planner.open(source);
    shots = shots_of(session.capture());
    if (shots.size() == 1 && beginning.dark == 0) {
      const auto plan_all = [&] { return planner.plan(source, std::move(session)); };
      const bool is_numbered = !source.clip.from || source.clip.from->is_picture;
      if (!session.is_clip() || !is_numbered) return plan_all();
      const std::uint64_t first = source.clip.from ? static_cast<std::uint64_t>(source.clip.from->value) : 0;
      return planner.or_scene(source, {first, first + session.timeline().sample_count()}, false, plan_all);
    }
    if (shots.size() > 1 && (!session.is_clip() || is_part)) {
      const bool is_numbered = source.clip.from && source.clip.from->is_picture;
      const std::uint64_t part = is_numbered ? static_cast<std::uint64_t>(source.clip.from->value) : 0;
      throw InputError(
          format("{}: it has {} shots, which begin at pictures {}{}. A study shows a single one: take that "
                 "from the clip",
                 name, shots.size(), starts_of(shots, part),
                 source.clip.from && !is_numbered ? " of the part that was asked for" : ""),
          {Setting::from, Setting::to});
    }
  }
  if (shots.size() == 1) return planner.plan_shot(source, shots.front());
  const std::string starts = starts_of(shots);
  const std::size_t count = shots.size();
  std::erase_if(shots, [](const SampleRange& shot) { return shot.size() < kMinSamples; });
  std::ranges::stable_sort(shots, std::ranges::greater(), &SampleRange::size);
  std::string reasons;
  std::optional<PlannedStudy> fallback;  // of the longest shot that makes no study, but a picture
  const auto taken = [&](PlannedStudy planned) {
    const SampleRange& part = *planned.part;
    planned.notes.emplace_back(
        format("the clip has {} shots, which begin at pictures {}: of the longest that makes a study, "
               "pictures {} … {} were taken",
               count, starts, part.first, part.last - 1),
        std::vector{Setting::from, Setting::to});
    return planned;
  };
  for (const SampleRange& shot : shots) {
    try {
      PlannedStudy planned = planner.plan_shot(source, shot);
      if (!planned.study.falls_short) return taken(std::move(planned));
      if (!fallback) fallback = std::move(planned);
    } catch (const InputError& reason) {
      const std::string_view text = reason.what();
      const std::string named = name + ": ";
      reasons += format("\n  {} … {}: {}", shot.first, shot.last - 1,
                        text.starts_with(named) ? text.substr(named.size()) : text);
    }
  }
  if (fallback) return taken(std::move(*fallback));
  throw InputError(format("{}: none of its {} shots, which begin at pictures {}, makes a study:{}", name,
                          count, starts, reasons));
}

}  // namespace

PlannedStudy plan_study(const SourceRequest& source, const StudyRequest& request, const StudyTerms& terms) {
  check_study(request);
  SourceRequest filmed = source;
  filmed.between.reset();
  PlannedStudy planned = plan_filmed(filmed, request, terms);
  if (planned.session.capture().header().made) {
    planned.notes.emplace_back(
        "the capture has samples made between its pictures, which are taken for pictures here: moments may lie on "
        "them. The clip itself is studied by what was filmed");
  }
  if (!has_trail(request)) return planned;
  const auto expose_between = [&](const BetweenRequest& between) {
    SourceRequest made = planned.session.source();
    made.between = between;
    Session session = ShotPlanner(request, terms, source.path.string()).open(made);
    planned.session = std::move(session);
    planned.study.functions = std::move(planned.study.functions_between);
  };
  const double step = planned.study.step_pixels;
  if (source.between) {
    expose_between(*source.between);
  } else if (planned.session.is_clip() && step >= kGhostPixels && planned.study.step_share >= kGhostShare) {
    const SampleRange& way = planned.study.way;
    const std::uint64_t last = std::min(way.last, planned.session.timeline().sample_count() - 1);
    std::string text = format("the trail is a row of copies, {:.0f} pixels apart, as far as the subject goes from one "
                              "picture to the next: samples made between pictures join them",
                              step);
    if (request.joins_trail && planned.study.step_share >= kApart && way.first < last) {
      const BetweenRequest between{.first = way.first, .last = last};
      try {
        expose_between(between);
        planned.between = between.text();
        const std::uint64_t part = planned.part ? planned.part->first : 0;  // numbers are the clip's
        const auto& made = planned.session.capture().header().made;
        text = format("the subject goes {:.0f} pixels from one picture to the next: ", step) +
               (made ? format("samples made between pictures {} … {} join its trail, but for {:.1f} % of what changes, "
                              "which could not be followed; off leaves it as it was filmed",
                              part + way.first, part + last, made->unfollowed_percent())
                     : "none of its motion could be followed to join its trail");
      } catch (const Error& error) {
        // Memory or room that is enough for the study alone, or events, each with its own time.
        if (!is_refusal(error)) throw;
        text += format("; here they cannot be made: {}", error.what());
      }
    }
    planned.notes.emplace_back(std::move(text), std::vector{Setting::between});
  }
  return planned;
}

}  // namespace nutik
