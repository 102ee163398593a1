#include "align/between.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <deque>
#include <vector>

#include "align/in_between.hpp"
#include "capture/format.hpp"
#include "capture/text.hpp"
#include "media/read_ahead.hpp"
#include "scene/shots.hpp"
#include "system/interruption.hpp"
#include "system/parallel.hpp"

namespace nutik {
namespace {

constexpr std::uint64_t kPairsAtOnce = 2;
// How much moves is looked for at no more pixels than this, each the mean of a square.
constexpr double kPlannedPixels = 250'000;

std::uint32_t planned_side(const Shape& shape) {
  return std::max(1U, static_cast<std::uint32_t>(std::ceil(std::sqrt(
                          static_cast<double>(shape.pixel_count()) / kPlannedPixels))));
}

class FilledClip final : public Clip {
 public:
  FilledClip(const ClipToAlign& clip, Shared<MadeSamples> made)
      : name_(clip.name),
        made_(std::move(made)),
        between_(clip.format),
        clip_(clip.open()),
        info_(clip_->info()),
        format_bytes_(clip.format.sample_bytes()) {
    const std::uint64_t grey_bytes = clip.format.shape.pixel_count();
    info_.decoder_bytes += pictures_.size() * (format_bytes_ + grey_bytes) + InBetween::bytes(clip.format);
    info_.sample_count = made_->total();
  }

  [[nodiscard]] const ClipInfo& info() const override { return info_; }

  bool read(std::span<std::byte> raster) override { return next(raster); }
  bool skip(std::span<std::byte>) override { return next({}); }

  [[nodiscard]] std::optional<std::string> ended_early() const override {
    if (auto reason = clip_->ended_early()) return reason;
    return lost_pictures_text(name_, clip_->info().sample_count, made_->after.size());
  }
  [[nodiscard]] std::vector<Note> remarks() const override { return clip_->remarks(); }

 private:
  // The next sample, into `raster` unless that is empty.
  bool next(std::span<std::byte> raster) {
    const std::vector<std::uint8_t>& after = made_->after;
    if (picture_ == after.size()) return false;
    if (step_ == 0) {
      if (picture_ == 0) {
        for (std::size_t i = 1; i < pictures_.size(); ++i) read_picture(i, i - 1);
      } else {
        std::rotate(pictures_.begin(), pictures_.begin() + 1, pictures_.end());
        read_picture(pictures_.size() - 1, picture_ + 2);
      }
      is_pair_taken_ = false;
      if (!raster.empty()) std::ranges::copy(pictures_[1].raster, raster.begin());
    } else if (!raster.empty()) {
      make(after[picture_] + 1U, raster);
    }
    if (step_++ == after[picture_]) {
      step_ = 0;
      ++picture_;
    }
    return true;
  }

  // Leaves nothing behind the last.
  void read_picture(std::size_t place, std::uint64_t number) {
    auto& [picture, grey] = pictures_[place];
    grey.clear();
    const bool is_there = number < made_->after.size();
    if (!is_there && is_read_) return picture.clear();
    picture.resize(format_bytes_);
    if (clip_->read(picture) != is_there) refuse_other_clip();
    if (!is_there) picture.clear();
    is_read_ = !is_there;
  }

  void make(std::uint32_t steps, std::span<std::byte> raster) {
    try {
      if (!is_pair_taken_) between_.take(pictures_[1], pictures_[2], pictures_[0], pictures_[3]);
    } catch (const CodeAboveWhite& error) {
      refuse_above_white(name_, picture_, error);
    }
    is_pair_taken_ = true;
    between_.make(step_, steps, raster);
  }

  [[noreturn]] void refuse_other_clip() const {
    throw InputError(format("{} does not have the {} pictures any more that samples were to be made between", name_,
                            made_->after.size()));
  }

  std::string name_;
  Shared<MadeSamples> made_;
  InBetween between_;
  std::unique_ptr<Clip> clip_;
  ClipInfo info_;
  std::uint64_t format_bytes_;
  // Filmed: one before the picture that was handed out last, that, and two behind it; empty: there is none.
  std::array<InBetween::Picture, 4> pictures_;
  bool is_read_ = false;  // all of the clip
  bool is_pair_taken_ = false;
  std::uint64_t picture_ = 0;  // filmed, that the next sample is or follows
  std::uint32_t step_ = 0;     // of those after it; 0: itself
};

}  // namespace

std::optional<BetweenRequest> parse_between(std::string_view text) {
  if (text == "off") return std::nullopt;
  const auto colon = text.find(':');
  const std::string_view how = text.substr(0, colon);
  std::string_view pictures = colon == text.npos ? std::string_view() : text.substr(colon + 1);
  const auto take = [](std::string_view& from, auto& number, std::string_view mark) {
    if (!take_number(from, number) || !from.starts_with(mark)) return false;
    from.remove_prefix(mark.size());
    return true;
  };
  BetweenRequest request;
  std::string_view rest = how;
  std::uint32_t each = 0;
  bool is_known = how == "auto" || (take(rest, each, "") && rest.empty() && each >= 1 && each <= MadeSamples::kMost);
  if (how != "auto") request.each = each;
  if (colon != text.npos) {
    is_known &= take(pictures, request.first, "f..") && take(pictures, request.last, "f") && pictures.empty() &&
                request.first < request.last;
  }
  if (is_known) return request;
  throw UsageError(format("between '{}' is not known; write auto, off, or how many samples are made between two "
                          "pictures, 1 … {}; auto:10f..20f makes them between these pictures alone",
                          text, MadeSamples::kMost));
}

std::string BetweenRequest::text() const {
  const std::string how = each ? std::to_string(*each) : "auto";
  return last == UINT64_MAX ? how : format("{}:{}f..{}f", how, first, last);
}

MadeSamples plan_between(const ClipToAlign& clip, const BetweenRequest& request, std::uint64_t memory_bytes,
                         const ReportedProgress& progress, const std::stop_token& stop) {
  const auto is_wanted = [&](std::uint64_t picture) { return picture >= request.first && picture < request.last; };
  const EvenGrey grey(clip.format, planned_side(clip.format.shape));
  const std::uint64_t sample_bytes = clip.format.sample_bytes();
  MemoryNeeds needs{{"pictures within the decoder", clip.decoder_bytes},
                    {"pictures decoded ahead", 2 * kPairsAtOnce * sample_bytes},
                    {"motion between pictures", kPairsAtOnce * PairMotion::bytes(grey.width(), grey.height())},
                    {"pictures in grey", (kPairsAtOnce + 3) * std::uint64_t{grey.width()} * grey.height()}};
  needs.rest_of(memory_bytes);
  const std::unique_ptr<Clip> pictures = clip.open();
  ReadAhead ahead(*pictures, 2 * kPairsAtOnce * sample_bytes);
  MadeSamples made;
  std::vector<PairMotion> motions;
  for (std::uint64_t i = 0; i < kPairsAtOnce; ++i) motions.emplace_back(grey.width(), grey.height());
  std::deque<std::vector<std::uint8_t>> greys;  // of pictures that pairs need still, the last of them
  std::uint64_t pictures_read = 0;
  CaptureFormat of_grey;
  of_grey.shape = {grey.width(), grey.height(), 1};
  ShotFinder shots(of_grey);
  struct Blocks {
    std::uint64_t changed, unfollowed;
  };
  std::vector<Blocks> blocks;  // between a picture and the next
  const auto add = [&](const PairMotion& motion) {
    const bool is_followed = is_wanted(made.after.size()) && motion.fastest() > 0 && !motion.is_cut();
    const double pixels = motion.fastest() * planned_side(clip.format.shape);
    if (made.after.size() == MadeSamples::kMostFilmed) {
      throw InputError(format("{} has more than {} pictures, between which samples are made", clip.name,
                              MadeSamples::kMostFilmed),
                       {Setting::between, Setting::to});
    }
    const std::uint32_t count = !is_followed ? 0 : request.each ? *request.each : PairMotion::steps_for(pixels) - 1;
    made.after.push_back(static_cast<std::uint8_t>(count));
    blocks.push_back({motion.changed(), motion.unfollowed()});
  };
  // Pairs behind which a picture is known, or is none.
  const auto follow = [&](bool is_end) {
    const auto grey_of = [&](std::uint64_t picture) {
      return picture < pictures_read ? greys[greys.size() - (pictures_read - picture)].data() : nullptr;
    };
    const std::uint64_t known = pictures_read - std::min<std::uint64_t>(pictures_read, is_end ? 1 : 2);
    while (made.after.size() < known) {
      const std::uint64_t first = made.after.size(), count = std::min(known - first, kPairsAtOnce);
      parallel_for(count, [&](std::uint64_t i) {
        const std::uint64_t picture = first + i;
        if (!is_wanted(picture)) return;
        motions[i].find({grey_of(picture), grey_of(picture + 1), picture > 0 ? grey_of(picture - 1) : nullptr,
                         grey_of(picture + 2)},
                        1);
      });
      for (std::uint64_t i = 0; i < count; ++i) add(motions[i]);
    }
    while (greys.size() > 3) greys.pop_front();
  };
  for (auto rasters = ahead.next(kPairsAtOnce); !rasters.empty(); rasters = ahead.next(kPairsAtOnce)) {
    check_interruption();
    if (stop.stop_requested()) throw Cancelled();
    if (progress) progress(pictures_read, clip.announced_samples);
    const std::size_t before = greys.size();
    greys.resize(before + rasters.size());
    parallel_for(rasters.size(), [&](std::uint64_t i) {
      try {
        grey.take(rasters[i], greys[before + i], 1);
      } catch (const CodeAboveWhite& error) {
        refuse_above_white(clip.name, pictures_read + i, error);
      }
    });
    for (std::size_t i = before; i < greys.size(); ++i) shots.add(std::as_bytes(std::span(greys[i])));
    pictures_read += rasters.size();
    follow(false);
  }
  follow(true);
  if (pictures_read > 0 && request.first > 0 && request.first + 1 >= pictures_read) {
    throw UsageError(format("between '{}' begins behind the last picture but one, {}f", request.text(),
                            std::max<std::uint64_t>(pictures_read, 2) - 2),
                     {Setting::between});
  }
  // A dissolve is known when it is over.
  for (std::uint64_t last = 0; const SampleRange& shot : shots.shots()) {
    for (std::uint64_t k = std::max<std::uint64_t>(last, 1) - 1; last > 0 && k < shot.first; ++k) made.after[k] = 0;
    last = shot.last;
  }
  for (std::size_t i = 0; i < blocks.size(); ++i) {
    if (made.after[i] == 0) continue;
    made.changed += blocks[i].changed;
    made.unfollowed += blocks[i].unfollowed;
  }
  if (pictures_read > 0) made.after.push_back(0);
  if (made.after.empty()) throw InputError(format("{} has no picture", clip.name));
  return made;
}

std::unique_ptr<Clip> open_between(const ClipToAlign& clip, const Shared<MadeSamples>& made) {
  return std::make_unique<FilledClip>(clip, made);
}

}  // namespace nutik
