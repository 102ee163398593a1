#include "media/clip_part.hpp"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <cstring>
#include <numeric>
#include <utility>
#include <vector>

#include "capture/error.hpp"
#include "capture/format.hpp"
#include "capture/light_means.hpp"
#include "capture/seconds_text.hpp"
#include "capture/text.hpp"
#include "system/input_bytes.hpp"
#include "system/parallel.hpp"

namespace nutik {

// `640 x 360 from 100,50 of 1920 x 1080`; crop_told() reads it.
static std::string crop_fact(const Rectangle& crop, const Shape& whole) {
  return format("{} x {} from {},{} of {} x {}", crop.width, crop.height, crop.x, crop.y, whole.width, whole.height);
}

std::optional<Rectangle> crop_told(const std::vector<std::string>& facts) {
  for (const std::string& fact : facts) {
    Rectangle crop;
    int length = 0;
    std::sscanf(fact.c_str(), "%u x %u from %u,%u of %*u x %*u%n", &crop.width, &crop.height, &crop.x, &crop.y,
                &length);
    if (length > 0) return crop;
  }
  return std::nullopt;
}

namespace {

// A clip without an announced end may go on for so long.
constexpr std::uint64_t kMaxSamples = std::uint64_t{1} << 40;

bool take_letter(std::string_view& text, char letter) {
  if (!text.starts_with(letter)) return false;
  text.remove_prefix(1);
  return true;
}

// Where the pictures of a clip begin.
class Starts {
 public:
  Starts(const std::string& name, const ClipInfo& info, const ClipOptions& options)
      : timeline_(timeline_of(name, info, options, Timeline::kFullShutter,
                              std::max<std::uint64_t>(info.picture_count(), 1))),
        count_(info.sample_count == 0 ? kMaxSamples : info.picture_count()) {}

  [[nodiscard]] std::int64_t of(std::uint64_t picture) const {
    if (!timeline_.is_constant()) return timeline_.start_ns(picture);
    const Rational rate = timeline_.rate();
    return round_half_up(static_cast<int128>(picture) * rate.denominator * kSecondNs, rate.numerator);
  }

  // The same of the first of a part. Throws UsageError where it is later than a capture can last.
  [[nodiscard]] std::int64_t of_part(std::uint64_t first) const {
    if (timeline_.is_constant())
      static_cast<void>(Timeline::constant(timeline_.rate(), Timeline::kFullShutter, first + 1));
    return of(first);
  }

  // The first that begins at or after that time; as many as there are where none does.
  [[nodiscard]] std::uint64_t first_from(std::int64_t time_ns) const {
    std::uint64_t first = 0, end = count_;
    while (first < end) {
      const std::uint64_t middle = first + (end - first) / 2;
      if (of(middle) < time_ns) {
        first = middle + 1;
      } else {
        end = middle;
      }
    }
    return first;
  }

 private:
  Timeline timeline_;
  std::uint64_t count_;
};

std::uint64_t picture_at(const ClipMoment& moment, const std::string& name, const ClipInfo& info,
                         const ClipOptions& options) {
  if (moment.value < 0) {
    throw UsageError(format("{}: a part of a clip begins at its start or later", name),
                     {Setting::from, Setting::to});
  }
  return moment.is_picture ? static_cast<std::uint64_t>(moment.value)
                           : Starts(name, info, options).first_from(moment.value);
}

template <typename Value>
void keep(std::vector<Value>& values, std::uint64_t first, std::uint64_t end) {
  if (values.empty()) return;
  values.resize(std::min<std::uint64_t>(values.size(), end));
  values.erase(values.begin(),
               values.begin() + static_cast<std::ptrdiff_t>(std::min<std::uint64_t>(first, values.size())));
}

// A clip's name without folders: machines of a farm may have it in different ones.
std::string file_name(const std::string& title) {
  const std::filesystem::path path = std::filesystem::path(title).lexically_normal();
  return (path.has_filename() ? path : path.parent_path()).filename().string();
}

class ClipPart final : public Clip {
 public:
  ClipPart(std::unique_ptr<Clip> clip, const std::filesystem::path& path, const ClipOptions& options)
      : name_(input_title(path.string())),
        clip_(std::move(clip)),
        info_(clip_->info()),
        whole_(info_.format) {
    choose_samples(options);
    crop_ = options.crop.value_or(Rectangle::whole(whole_.shape));
    if (options.crop) crop(*options.crop);
    if (options.scale) scale(*options.scale);
    if (crop_ != Rectangle::whole(whole_.shape) || means_) raster_.resize(whole_.sample_bytes());
    info_.decoder_bytes += raster_.size();
  }

  [[nodiscard]] const ClipInfo& info() const override { return info_; }

  bool read(std::span<std::byte> raster) override {
    const bool is_whole = raster_.empty();
    const std::span<std::byte> picture = is_whole ? raster : std::span(raster_);
    if (next_ < first_) skip_to_part(picture);
    if (next_ >= end_ || !clip_->read(picture)) return false;
    ++next_;
    if (is_whole) return true;
    if (means_) {
      try {
        means_->check(raster_, whole_.code_bytes);
      } catch (const CodeAboveWhite& error) {
        throw InputError(format("{}: picture {} has the code {}, and white is {}", name_, next_ - 1,
                                error.code, whole_.white_code),
                         {Setting::white_code});
      }
      constexpr std::uint64_t kRowsAtOnce = 16;
      parallel_for_parts(info_.format.shape.height, kRowsAtOnce, [&](std::uint64_t begin, std::uint64_t end) {
        means_->take(raster_, whole_.code_bytes, raster, whole_.code_bytes, begin, end);
      });
      return true;
    }
    const std::size_t pixel = std::size_t{whole_.shape.channels} * whole_.code_bytes;
    const std::size_t row = crop_.width * pixel;
    for (std::uint32_t y = 0; y < crop_.height; ++y) {
      const std::size_t from = (std::size_t{crop_.y + y} * whole_.shape.width + crop_.x) * pixel;
      std::memcpy(raster.data() + y * row, raster_.data() + from, row);
    }
    return true;
  }

  [[nodiscard]] bool tells_changes() const override { return clip_->tells_changes() && !means_; }
  [[nodiscard]] bool makes_codes() const override { return clip_->makes_codes(); }

  std::optional<std::span<const PixelChange>> read_changes() override {
    if (next_ >= end_) return std::nullopt;
    auto changes = clip_->read_changes();
    if (!changes) return std::nullopt;
    ++next_;
    if (raster_.empty()) return changes;
    changes_.clear();
    for (PixelChange change : *changes) {
      const std::uint32_t x = change.pixel % whole_.shape.width, y = change.pixel / whole_.shape.width;
      if (x < crop_.x || y < crop_.y || x >= crop_.x + crop_.width || y >= crop_.y + crop_.height) continue;
      change.pixel = (y - crop_.y) * crop_.width + x - crop_.x;
      changes_.push_back(change);
    }
    return changes_;
  }

  [[nodiscard]] std::optional<std::string> ended_early() const override { return clip_->ended_early(); }
  [[nodiscard]] std::vector<Note> remarks() const override { return clip_->remarks(); }

 private:
  void skip_to_part(std::span<std::byte> raster) {
    for (; next_ < first_; ++next_) {
      if (clip_->tells_changes() ? clip_->read_changes().has_value() : clip_->skip(raster)) continue;
      next_ = end_ = first_;
      return;
    }
  }

  void choose_samples(const ClipOptions& options) {
    if (!options.from && !options.to) return;
    const ClipInfo& info = clip_->info();
    const std::uint64_t count = info.picture_count();
    if (options.from) first_ = picture_at(*options.from, name_, info, options);
    if (options.to) end_ = picture_at(*options.to, name_, info, options);
    std::string pictures = count == 0 ? "" : format(", which has {} pictures (0f … {}f", count, count - 1);
    if (count > 0 && (options.rate || info.timing.is_known()))
      pictures += format(", the last from {} on", seconds_text(Starts(name_, info, options).of(count - 1)));
    if (count > 0) pictures += ")";
    if (count > 0 && first_ >= count) {
      throw UsageError(format("no picture begins that late in {}{}", name_, pictures), {Setting::from});
    }
    if (first_ >= end_) {
      const std::string_view what =
          first_ > end_ ? "the part ends before it begins" : "no picture begins between the two";
      throw UsageError(format("{} in {}{}", what, name_, pictures),
                       {Setting::from, Setting::to});
    }
    if (count > 0 && options.to && options.to->is_picture && end_ > count) {
      throw UsageError(format("picture {} is not in {}{}", end_, name_, pictures), {Setting::to});
    }
    if (count > 0) end_ = std::min(end_, count);
    info_.part = PartOfClip{first_, 0, count, file_name(name_)};
    if (first_ > 0 && (options.rate || info.timing.is_known()))
      info_.part->start_ns = Starts(name_, info, options).of_part(first_);
    keep_times();
    info_.sound.reset();  // of the whole clip
    info_.facts.push_back({info_.part->text(end_ == kMaxSamples ? std::nullopt : std::optional(end_)),
                           Origin::stated, options.from ? Setting::from : Setting::to});
    if (info.made) keep_made(**info.made);
    if (count > 0) info_.sample_count = end_ - first_;
  }

  // Keeps the samples that were made between two pictures of the part; from here on it counts both.
  void keep_made(MadeSamples made) {
    made.after.resize(end_);
    made.after.back() = 0;
    end_ = made.total();
    made.after.erase(made.after.begin(), made.after.begin() + static_cast<std::ptrdiff_t>(first_));
    first_ = end_ - made.total();
    info_.made.reset();
    if (made.count() > 0) info_.made.emplace(std::move(made));
  }

  // Each picture is exposed, and holds, for as long as it does in the clip.
  void keep_times() {
    ClipTiming& timing = info_.timing;
    const std::vector<std::int64_t>& starts = timing.starts_ns;
    // The clip's last one holds as long as the one before it.
    if (const std::size_t count = starts.size(); first_ + 1 == count && count > 1 && !timing.exposed_ns) {
      const int128 next = int128{2} * starts[count - 1] - starts[count - 2];
      if (next > starts[count - 1] && next <= INT64_MAX)
        timing.starts_ns.push_back(static_cast<std::int64_t>(next));
    }
    keep(timing.starts_ns, first_, end_ + 1);
    keep(timing.exposures, first_, end_);
  }

  void crop(const Rectangle& wanted) {
    const Shape& shape = whole_.shape;
    if (!wanted.lies_in(shape)) {
      throw UsageError(
          format("{} x {} pixels from {},{} on do not lie in the pictures of {}, which have {} x {}",
                 wanted.width, wanted.height, wanted.x, wanted.y, name_, shape.width, shape.height),
          {Setting::crop});
    }
    info_.format.shape.width = wanted.width;
    info_.format.shape.height = wanted.height;
    info_.facts.push_back({crop_fact(wanted, shape), Origin::stated, Setting::crop});
  }

  void scale(const ClipScale& wanted) {
    Shape scaled = whole_.shape;
    if (wanted.divisor > 0) {
      scaled.width = crop_.width / wanted.divisor;
      scaled.height = crop_.height / wanted.divisor;
      crop_.width = scaled.width * wanted.divisor;
      crop_.height = scaled.height * wanted.divisor;
    } else {
      scaled.width = wanted.width;
      scaled.height = wanted.height;
    }
    const Shape& shape = info_.format.shape;
    if (scaled.width == 0 || scaled.height == 0 || scaled.width > shape.width ||
        scaled.height > shape.height) {
      throw UsageError(
          format("{} x {} pixels cannot be made of {} x {}: pictures are made smaller, not larger, and "
                 "have a pixel at least",
                 scaled.width, scaled.height, shape.width, shape.height),
          {Setting::scale});
    }
    // What a pixel covers is so much wider, or less wide, than one of the clip.
    const Rational covered =
        Rational::of(std::int64_t{crop_.width} * scaled.height, std::int64_t{crop_.height} * scaled.width);
    info_.format.pixel_aspect = product(info_.format.pixel_aspect, covered);
    info_.facts.push_back(
        {format("{} x {} as means of light", scaled.width, scaled.height), Origin::stated, Setting::scale});
    info_.format.shape = scaled;
    info_.roundings.add();
    means_.emplace(whole_.shape, crop_, scaled, whole_.transfer.light_of_codes(whole_.white_code),
                   LightCodes(whole_.transfer, whole_.white_code));
  }

  // Close to that of two fractions that are too long for the header of a capture.
  [[nodiscard]] static Rational product(const Rational& a, const Rational& b) {
    const Rational left = Rational::of(a.numerator, b.denominator),
                   right = Rational::of(b.numerator, a.denominator);
    constexpr std::int64_t kMax = INT32_MAX;
    if (left.numerator <= kMax / right.numerator && left.denominator <= kMax / right.denominator) {
      return Rational::of(left.numerator * right.numerator, left.denominator * right.denominator);
    }
    constexpr std::int64_t kParts = 1'000'000;
    return Rational::of(std::llround(a.value() * b.value() * kParts), kParts);
  }

  std::string name_;
  std::unique_ptr<Clip> clip_;
  ClipInfo info_;
  CaptureFormat whole_;  // of the clip's pictures
  Rectangle crop_;
  std::uint64_t first_ = 0, end_ = kMaxSamples, next_ = 0;  // of what the clip reads
  std::vector<std::byte> raster_;                            // one of them, unless it is taken as it is
  std::optional<LightMeans> means_;
  std::vector<PixelChange> changes_;  // within the rectangle
};

}  // namespace

Rectangle parse_crop(std::string_view text) {
  Rectangle crop;
  std::string_view rest = text;
  if (take_number(rest, crop.width) && take_letter(rest, 'x') && take_number(rest, crop.height) &&
      take_letter(rest, '+') && take_number(rest, crop.x) && take_letter(rest, '+') &&
      take_number(rest, crop.y) && rest.empty() && crop.width > 0 && crop.height > 0) {
    return crop;
  }
  throw UsageError(
      format("crop '{}' is no rectangle; write its size and how far it lies from the left and from the top: "
             "640x360+100+50",
             text));
}

ClipScale parse_scale(std::string_view text) {
  ClipScale scale;
  std::string_view rest = text;
  std::uint32_t first = 0, second = 0;
  if (take_number(rest, first) && first > 0) {
    if (first == 1 && take_letter(rest, '/') && take_number(rest, second) && rest.empty() && second > 0) {
      scale.divisor = second;
      return scale;
    }
    if (take_letter(rest, 'x') && take_number(rest, second) && rest.empty() && second > 0) {
      scale.width = first;
      scale.height = second;
      return scale;
    }
  }
  throw UsageError(format("scale '{}' is not known; write 1/2, 1/3, … or a size: 640x360", text));
}

std::unique_ptr<Clip> take_part(std::unique_ptr<Clip> clip, const std::filesystem::path& path,
                                const ClipOptions& options) {
  if (!options.from && !options.to && !options.crop && !options.scale) return clip;
  return std::make_unique<ClipPart>(std::move(clip), path, options);
}

}  // namespace nutik
