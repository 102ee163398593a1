#include "align/alignment.hpp"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <memory>
#include <optional>
#include <utility>
#include <vector>

#include "align/light_warp.hpp"
#include "align/registrar.hpp"
#include "capture/format.hpp"
#include "imev/each_block.hpp"
#include "media/read_ahead.hpp"
#include "system/interruption.hpp"
#include "system/parallel.hpp"

namespace nutik {
namespace {

// Up to so many pictures are searched for at once, if memory allows it. All of a group start from where the last
// picture of the group before was found, so that the path depends on neither memory nor threads.
constexpr std::uint64_t kPicturesAtOnce = 4;

// The raster of the picture that the others are moved onto.
std::vector<std::byte> reference_raster(const ClipToAlign& clip) {
  const std::unique_ptr<Clip> pictures = clip.open();
  std::vector<std::byte> raster(clip.format.sample_bytes());
  for (std::uint64_t picture = 0; picture <= clip.reference; ++picture) {
    check_interruption();
    if (pictures->read(raster)) continue;
    throw InputError(format("{} has {} pictures: there is no picture {} to align them to", clip.name, picture,
                            clip.reference));
  }
  return raster;
}

const Advice kOtherReference{"; try another picture to align to (`align-to`), or a part of the clip (`from`, `to`)"};

CannotAlign not_alike(const ClipToAlign& clip, CameraMotion asked, CameraMotion motion, std::uint64_t picture,
                      const Registered& found) {
  CannotAlign error(
      format("{}: picture {} cannot be aligned to picture {}: of what is seen in both {:.1f} % follow one "
             "{} motion, and half must. The camera moved too far or too fast, there is a cut or a dissolve between "
             "them, or what moves by itself fills most of the picture",
             clip.name, picture, clip.reference, std::floor(1000 * found.agreeing) / 10, to_text(motion)),
      asked == CameraMotion::homography || asked == CameraMotion::automatic
          ? kOtherReference
          : Advice{"; try `align auto`, another picture to align to (`align-to`), or a part of the clip "
                   "(`from`, `to`)"});
  error.picture = picture;
  error.motion = motion;
  return error;
}

// Looks for a camera's path by the motion that is wanted, or by two, each until a picture does not follow it.
class PathSearch {
 public:
  PathSearch(const ClipToAlign& clip, CameraMotion motion)
      : clip_(clip), asked_(motion), tried_{{.path = path_of(motion)}} {
    if (motion != CameraMotion::automatic) return;
    tried_ = {{.path = path_of(CameraMotion::rigid)}, {.path = path_of(CameraMotion::homography)}};
  }

  [[nodiscard]] std::uint64_t picture_count() const { return tried_.front().path.pictures.size(); }

  // Finds the next pictures. Throws CannotAlign where no motion is left that all pictures follow.
  void add(Registrar& registrar, std::span<const std::span<const std::byte>> rasters) {
    std::vector<Registrar::Compared> compared(rasters.size());
    const bool are_two = tried_.size() == 2;
    parallel_for(rasters.size(), [&](std::uint64_t i) {
      if (are_two) {
        compared[i] = registrar.compare(rasters[i], {tried_[0].path.motion, tried_[1].path.motion},
                                        {tried_[0].guess, tried_[1].guess});
      } else {
        compared[i].found[0] = registrar.find(rasters[i], tried_[0].path.motion, tried_[0].guess);
      }
    });
    std::optional<CannotAlign> failed;
    std::vector<Tried> left;
    for (std::size_t which = 0; which < tried_.size(); ++which) {
      try {
        for (std::size_t i = 0; i < rasters.size(); ++i)
          add(tried_[which], registrar, rasters[i], compared[i].found[which]);
        left.push_back(std::move(tried_[which]));
      } catch (const CannotAlign& error) {
        if (!failed || error.picture >= failed->picture) failed = error;
      }
    }
    if (left.empty()) throw std::move(*failed);
    tried_ = std::move(left);
    for (const Registrar::Compared& each : compared) {
      for (std::size_t part = 0; part < better_.size(); ++part) better_[part] += each.better[part];
    }
    constexpr std::uint64_t kMany = 32;  // fewer are alike by chance, as pictures that follow each other are
    constexpr double kSurely = 4;        // asked after each group
    const bool is_due = picture_count() >= kMany && picture_count() % kPicturesAtOnce == 0;  // in groups of one, too
    if (is_due && second_gains(kSurely)) tried_.erase(tried_.begin());
  }

  [[nodiscard]] CameraPath best() && {
    constexpr double kOnceInTwenty = 1.64;  // by chance
    return std::move(second_gains(kOnceInTwenty) ? tried_.back().path : tried_.front().path);
  }

 private:
  struct Tried {
    CameraPath path;
    Warp guess = {};
  };

  // Whether there is a second motion that says more than the first. It can do more, and so it follows noise and what
  // moves, too: in so many standard deviations more parts of the picture than chance would it must say better.
  [[nodiscard]] bool second_gains(double sigmas) const {
    const auto better = static_cast<double>(std::ranges::count_if(better_, [](int each) { return each > 0; }));
    const auto worse = static_cast<double>(std::ranges::count_if(better_, [](int each) { return each < 0; }));
    return tried_.size() == 2 && better - worse > sigmas * std::sqrt(better + worse);
  }

  [[nodiscard]] CameraPath path_of(CameraMotion motion) const {
    return {motion, clip_.format.shape, clip_.reference, {}};
  }

  void add(Tried& tried, Registrar& registrar, std::span<const std::byte> raster, Registered picture) const {
    CameraPath& path = tried.path;
    const std::uint64_t number = path.pictures.size();
    // A fast camera is nearer to where it was just before.
    if (!is_sure(picture) && number > 0 && path.pictures.back().warp != tried.guess)
      picture = registrar.find(raster, path.motion, path.pictures.back().warp);
    if (!is_sure(picture)) throw not_alike(clip_, asked_, path.motion, number, picture);
    if ((number + 1) % kPicturesAtOnce == 0) tried.guess = picture.warp;
    if (number == clip_.reference) picture.warp = Warp();  // itself
    path.pictures.push_back(picture);
  }

  const ClipToAlign& clip_;
  CameraMotion asked_;
  std::vector<Tried> tried_;
  std::array<int, std::tuple_size_v<BetterParts>> better_{};  // in how many pictures the second one is, by part
};

class AlignedClip final : public Clip {
 public:
  AlignedClip(const ClipToAlign& clip, Shared<CameraPath> path, const Rectangle& area, Unseen unseen)
      : name_(clip.name),
        path_(std::move(path)),
        warp_(clip.format, area),
        held_(unseen == Unseen::held ? reference_raster(clip) : std::vector<std::byte>()),
        clip_(clip.open()),
        info_(clip_->info()),
        raster_(clip.format.sample_bytes()) {
    info_.format.shape.width = area.width;
    info_.format.shape.height = area.height;
    info_.roundings.add(0.5, 0.0, "interpolation");
    info_.decoder_bytes += raster_.size() + held_.size() + LightWarp::bytes(clip.format);
  }

  [[nodiscard]] const ClipInfo& info() const override { return info_; }

  bool read(std::span<std::byte> raster) override {
    const bool goes_on = clip_->read(raster_);
    const std::uint64_t picture = next_++, count = path_->pictures.size();
    if (goes_on != (picture < count)) {
      throw InputError(format("the camera's path is that of {} pictures, and {} has {}", count, name_,
                              goes_on ? "more" : std::to_string(picture)));
    }
    if (!goes_on) return false;
    try {
      // What was not seen holds.
      warp_.take(raster_, path_->pictures[picture].warp, held_.empty() ? raster : std::span(held_));
    } catch (const CodeAboveWhite& error) {
      refuse_above_white(name_, picture, error);
    }
    if (!held_.empty()) std::memcpy(raster.data(), held_.data(), held_.size());
    return true;
  }

  [[nodiscard]] std::optional<std::string> ended_early() const override { return clip_->ended_early(); }
  [[nodiscard]] std::vector<Note> remarks() const override { return clip_->remarks(); }

 private:
  std::string name_;
  Shared<CameraPath> path_;
  LightWarp warp_;
  std::vector<std::byte> held_;  // before the clip, so that one decoder at a time is open
  std::unique_ptr<Clip> clip_;
  ClipInfo info_;
  std::vector<std::byte> raster_;
  std::uint64_t next_ = 0;
};

}  // namespace

void refuse_above_white(const std::string& name, std::uint64_t picture, const CodeAboveWhite& error) {
  throw InputError(format("{}: picture {} has the code {}, which is above white", name, picture, error.code),
                   {Setting::white_code});
}

CameraPath find_camera_path(const ClipToAlign& clip, CameraMotion motion, std::uint64_t memory_bytes,
                            const ReportedProgress& progress, const std::stop_token& stop) {
  const std::uint64_t sample_bytes = clip.format.sample_bytes();
  MemoryNeeds needs{{"pictures within the decoder", clip.decoder_bytes},
                    {"pictures decoded ahead", 2 * sample_bytes},
                    {"the picture that others are aligned to", sample_bytes}};
  needs.add(registrar_needs(clip.format, Reach::anywhere));
  const std::uint64_t spare = needs.rest_of(memory_bytes);
  const std::uint64_t at_once = spare / (kPicturesAtOnce - 1) >= 2 * sample_bytes + registered_bytes(clip.format)
                                    ? kPicturesAtOnce
                                    : 1;

  std::unique_ptr<Registrar> registrar;
  try {
    registrar = open_registrar(clip.format, reference_raster(clip));
  } catch (const TooLittleTexture& error) {
    throw CannotAlign(
        format("{}: no picture can be aligned to picture {}: {}", clip.name, clip.reference, error.what()),
        kOtherReference);
  }
  PathSearch search(clip, motion);
  const std::unique_ptr<Clip> pictures = clip.open();
  ReadAhead ahead(*pictures, 2 * at_once * sample_bytes);
  for (auto rasters = ahead.next(at_once); !rasters.empty(); rasters = ahead.next(at_once)) {
    check_interruption();
    if (stop.stop_requested()) throw Cancelled();
    if (progress) progress(search.picture_count(), clip.announced_samples);
    search.add(*registrar, rasters);
  }
  return std::move(search).best();
}

Rectangle shown_area(const std::string& name, const CameraPath& path, Unseen unseen) {
  if (unseen == Unseen::held) return Rectangle::whole(path.shape);
  if (const auto area = seen_by_all(path)) return *area;
  const std::uint64_t picture = path.furthest().picture;
  const CameraPath::Step step = path.step(picture);
  throw CannotAlign(
      format("{}: no place was seen by all of its {} pictures: in picture {} the camera looks "
             "{:.0f} pixels to the side and {:.0f} up or down from where it did in picture {}",
             name, path.pictures.size(), picture, std::abs(step.x), std::abs(step.y), path.reference),
      Advice{"; take a part of the clip (`from`, `to`), or keep the picture's size (`unseen hold`)"});
}

std::unique_ptr<Clip> open_aligned(const ClipToAlign& clip, const Shared<CameraPath>& path, Unseen unseen) {
  const Shape& shape = clip.format.shape;
  if (path->shape.width != shape.width || path->shape.height != shape.height) {
    throw InputError(format("the camera's path is that of pictures of {} x {}, and {} has {} x {}",
                            path->shape.width, path->shape.height, clip.name, shape.width, shape.height));
  }
  return std::make_unique<AlignedClip>(clip, path, shown_area(clip.name, *path, unseen), unseen);
}

std::string alignment_text(const CameraPath& path, const Rectangle& area, Unseen unseen) {
  const std::string shown =
      unseen == Unseen::held
          ? "what a picture did not see holds what was seen there before"
          : format("cropped to what all of them saw, {} x {} pixels from {},{} on", area.width, area.height, area.x,
                   area.y);
  const auto residual = path.residual_pixels();
  return format(
      "aligned to picture {} ({}), from which others are {}; {}{}", path.reference, to_text(path.motion),
      path.summary(),
      residual ? format("half of what has texture is now within {:.2f} pixels of its place; ", *residual) : "", shown);
}

tik::Alignment kept_alignment(const CameraPath& path, Unseen unseen) {
  return {std::string(to_text(path.motion)),
          path.reference,
          unseen == Unseen::held,
          path.furthest().pixels(),
          std::abs(path.step(path.max_turned()).degrees),
          path.residual_pixels()};
}

std::string alignment_text(const tik::Alignment& aligned) {
  const std::string turned = aligned.turned_degrees == 0
                                 ? std::string()
                                 : format(" and turned by up to {:.3f} degrees", aligned.turned_degrees);
  return format(
      "to picture {} ({}), from which others were moved by up to {:.2f} pixels{}; what a picture did not see "
      "{}",
      aligned.reference, aligned.motion, aligned.moved_pixels, turned,
      aligned.holds_unseen ? "holds what was seen before" : "was cut away");
}

namespace {

constexpr std::uint64_t kLooks = 9;
// Less is not told from what compression and rolling shutters do.
constexpr double kMinPixels = 1.0;

}  // namespace

std::string MovedCamera::text() const {
  if (is_untold()) {
    return format(
        "whether the camera moved could not be told: {} of {} pictures could not be compared with the first, as in low "
        "light, in blur, or where what moves fills the picture",
        unsure, looks);
  }
  const std::string moved = format("{:.1f} pixels and {:.2f} degrees", pixels, degrees);
  return format("the camera moved by {}, and still things are not still",
                unsure == 0 ? format("up to {}, most at sample {}", moved, sample)
                            : format("{} or more (at sample {}; {} of {} pictures could not be compared)", moved,
                                     sample, unsure, looks));
}

MemoryNeeds camera_check_needs(const CaptureFormat& capture) {
  MemoryNeeds needs = registrar_needs(capture, Reach::near);
  needs.add("a picture of the capture", capture.sample_bytes());
  return needs;
}

const std::optional<MovedCamera>& CameraLooks::look(std::uint64_t sample, std::span<const std::byte> raster) {
  if (looks_++ == 0) {
    try {
      registrar_ = open_registrar(format_, raster);
    } catch (const TooLittleTexture&) {
      return moved_;
    }
  } else if (registrar_) {
    // From where it lay at first: what stands still is found there.
    const Registered found = registrar_->find(raster, CameraMotion::rigid, Warp(), Reach::near);
    const Place way = furthest_way(found.warp, format_.shape);
    const double corner = std::hypot(way.x, way.y);
    if (!is_sure(found)) {
      ++unsure_;
      seemingly_ = std::max(seemingly_, corner);
    } else if (corner >= (moved_ ? moved_->pixels : kMinPixels)) {
      const double degrees =
          found.warp.degrees_at((format_.shape.width - 1) / 2.0, (format_.shape.height - 1) / 2.0);
      moved_ = {.pixels = corner, .degrees = std::abs(degrees), .sample = sample};
    }
  }
  return moved_;
}

std::optional<MovedCamera> CameraLooks::moved() const {
  std::optional<MovedCamera> moved = moved_;
  if (!moved && registrar_ && 2 * unsure_ >= looks_ && registrar_->sees_much())
    moved = {.seemingly_pixels = seemingly_};
  if (moved) {
    moved->looks = looks_;
    moved->unsure = unsure_;
  }
  return moved;
}

std::optional<MovedCamera> moved_camera(tik::Reader& capture) {
  if (capture.header().alignment) return std::nullopt;
  const std::uint64_t count = capture.timeline().sample_count();
  std::vector<std::byte> raster(capture.format().sample_bytes());
  CameraLooks camera(capture.format());
  const std::uint64_t looks = std::min(count, kLooks);
  for (std::uint64_t look = 0; look < looks; ++look) {
    const std::uint64_t sample = count <= kLooks ? look : look * (count - 1) / (kLooks - 1);
    for_each_block(capture, {sample, sample + 1}, [&](const BlockView& block) {
      block.read_sample(static_cast<std::uint32_t>(sample - block.extent().first_sample), raster);
    });
    camera.look(sample, raster);
  }
  return camera.moved();
}

}  // namespace nutik
