#include <libexif/exif-data.h>
#include <libexif/exif-utils.h>

#include <array>
#include <chrono>
#include <memory>
#include <string>

#include "capture/rational.hpp"
#include "capture/text.hpp"
#include "media/formats/file_kinds.hpp"
#include "media/stills/raw_file.hpp"
#include "media/stills/stills.hpp"

namespace nutik::stills {
namespace {

struct FreeExif {
  void operator()(ExifData* data) const { exif_data_unref(data); }
};

ExifEntry* entry_of(const ExifData& data, ExifTag tag) {
  return exif_content_get_entry(data.ifd[EXIF_IFD_EXIF], tag);
}

using Exif = std::unique_ptr<ExifData, FreeExif>;

unsigned orientation_of(const Exif& data) {
  const ExifEntry* entry = data ? exif_content_get_entry(data->ifd[EXIF_IFD_0], EXIF_TAG_ORIENTATION) : nullptr;
  if (entry == nullptr || entry->format != EXIF_FORMAT_SHORT || entry->size < 2) return 1;
  const unsigned orientation = exif_get_short(entry->data, exif_data_get_byte_order(data.get()));
  return orientation >= 1 && orientation <= 8 ? orientation : 1;
}

std::string text_of(const ExifData& data, ExifTag tag) {
  const ExifEntry* entry = entry_of(data, tag);
  if (entry == nullptr || entry->format != EXIF_FORMAT_ASCII) return {};
  const std::string text(reinterpret_cast<const char*>(entry->data), entry->size);
  return text.substr(0, text.find('\0'));
}

// `2026:11:21 13:22:27`, in nanoseconds since 1970, of whatever clock the camera had.
std::optional<std::int64_t> date_ns(const std::string& text) {
  constexpr std::array<std::size_t, 6> kAt{0, 5, 8, 11, 14, 17}, kDigits{4, 2, 2, 2, 2, 2};
  std::array<unsigned, 6> part{};
  if (text.size() < 19) return std::nullopt;
  for (std::size_t i = 0; i < part.size(); ++i) {
    const auto number = parsed<unsigned>(std::string_view(text).substr(kAt[i], kDigits[i]));
    if (!number) return std::nullopt;
    part[i] = *number;
  }
  const std::chrono::year_month_day day{std::chrono::year(static_cast<int>(part[0])),
                                        std::chrono::month(part[1]), std::chrono::day(part[2])};
  // Nanoseconds since 1970 reach from 1678 to 2262; second 60 is a leap second.
  if (!day.ok() || part[0] < 1700 || part[0] > 2200) return std::nullopt;
  if (part[3] > 23 || part[4] > 59 || part[5] > 60) return std::nullopt;
  const std::int64_t days = std::chrono::sys_days(day).time_since_epoch().count();
  return (((days * 24 + part[3]) * 60 + part[4]) * 60 + part[5]) * kSecondNs;
}

// The digits behind a second's point, as many as the camera wrote.
std::int64_t fraction_ns(const std::string& digits) {
  std::int64_t value = 0, unit = kSecondNs / 10;
  for (const char digit : digits) {
    if (digit < '0' || digit > '9') break;
    value += (digit - '0') * unit;
    unit /= 10;
  }
  return value;
}

// `+02:00`, how far a clock was ahead of that of the world; 0 where a camera does not say.
std::int64_t zone_ns(const std::string& text) {
  if (text.size() != 6 || (text[0] != '+' && text[0] != '-') || text[3] != ':') return 0;
  const auto hours = parsed<unsigned>(text.substr(1, 2)), minutes = parsed<unsigned>(text.substr(4, 2));
  if (!hours || !minutes || *hours > 23 || *minutes > 59) return 0;
  return (text[0] == '-' ? -1 : 1) * (std::int64_t{*hours} * 60 + *minutes) * 60 * kSecondNs;
}

}  // namespace

unsigned exif_orientation(const std::filesystem::path& jpeg) {
  return orientation_of(Exif(exif_data_new_from_file(jpeg.c_str())));
}

StillTimes read_exif_times(const std::filesystem::path& file) {
  if (const auto* kind = still_kind(file); kind != nullptr && *kind == inputs::kDng) {
    const RawTags tags = read_raw_tags(file);
    StillTimes times{date_ns(tags.date), tags.exposure_ns};
    if (times.start_ns) *times.start_ns += fraction_ns(tags.fraction) - zone_ns(tags.zone);
    return times;
  }
  const Exif data(exif_data_new_from_file(file.c_str()));
  StillTimes times;
  if (!data) return times;
  times.start_ns = date_ns(text_of(*data, EXIF_TAG_DATE_TIME_ORIGINAL));
  if (times.start_ns) {
    *times.start_ns += fraction_ns(text_of(*data, EXIF_TAG_SUB_SEC_TIME_ORIGINAL)) -
                       zone_ns(text_of(*data, EXIF_TAG_OFFSET_TIME_ORIGINAL));
  }
  const ExifEntry* exposure = entry_of(*data, EXIF_TAG_EXPOSURE_TIME);
  if (exposure != nullptr && exposure->format == EXIF_FORMAT_RATIONAL && exposure->size >= 8) {
    const ExifRational seconds = exif_get_rational(exposure->data, exif_data_get_byte_order(data.get()));
    if (seconds.numerator != 0 && seconds.denominator != 0) {
      times.exposure_ns = std::max<std::int64_t>(
          round_half_up(static_cast<int128>(seconds.numerator) * kSecondNs, seconds.denominator), 1);
    }
  }
  return times;
}

}  // namespace nutik::stills
