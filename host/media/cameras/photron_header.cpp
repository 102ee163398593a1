#include "media/cameras/photron_header.hpp"

#include <algorithm>
#include <array>
#include <vector>

#include "capture/error.hpp"
#include "capture/text.hpp"
#include "media/formats/extension.hpp"
#include "system/input_bytes.hpp"
#include "system/is_absent.hpp"
#include "system/mapped_file.hpp"

namespace nutik {
namespace {

namespace fs = std::filesystem;

// A value's names: that of a line, `Image Width : 384`, and that of an XML element behind those round it. Empty: none.
struct Names {
  std::string_view line;
  std::array<std::string_view, 3> elements;
};

// Behind the name at a line's start and its colon; `Total Frame` is no part of `Original Total Frame`.
std::string_view behind_line(std::string_view text, std::string_view name) {
  if (name.empty()) return {};
  for (auto at = text.find(name); at != text.npos; at = text.find(name, at + 1)) {
    if (at > 0 && text[at - 1] != '\n') continue;
    std::string_view rest = text.substr(at + name.size());
    rest = trimmed(rest.substr(0, rest.find('\n')));
    if (rest.starts_with(':')) return trimmed(rest.substr(1));
  }
  return {};
}

std::string_view within_element(std::string_view text, std::string_view name) {
  const std::string open = "<" + std::string(name) + ">", close = "</" + std::string(name) + ">";
  const auto at = text.find(open);
  if (at == text.npos) return {};
  const std::string_view rest = text.substr(at + open.size());
  return trimmed(rest.substr(0, rest.find(close)));
}

std::string_view value_of(std::string_view text, const Names& names) {
  if (const auto value = behind_line(text, names.line); !value.empty()) return value;
  for (const std::string_view element : names.elements) {
    if (!element.empty()) text = within_element(text, element);
  }
  return names.elements.back().empty() || text.find('<') != text.npos ? std::string_view() : text;
}

std::uint64_t number_of(std::string_view text, const Names& names) {
  return parsed<std::uint32_t>(value_of(text, names)).value_or(0);
}

std::string word_of(std::string_view text, const Names& names) { return in_small_letters(value_of(text, names)); }

std::optional<Rational> fraction_of(std::string_view text, const Names& names) {
  const std::string_view value_text = value_of(text, names);
  try {
    const Rational value =
        Rational::parse(value_text.substr(0, value_text.find_first_not_of("0123456789./")), names.line);
    return value.numerator > 0 ? std::optional(value) : std::nullopt;
  } catch (const UsageError&) {
    return std::nullopt;
  }
}

std::optional<std::int64_t> nanoseconds(const std::optional<Rational>& seconds) {
  if (!seconds) return std::nullopt;
  const std::int64_t ns =
      round_half_up(static_cast<int128>(seconds->numerator) * kSecondNs, seconds->denominator);
  return ns > 0 ? std::optional(ns) : std::nullopt;
}

// `rate`: of filming, not of what was saved.
std::optional<std::int64_t> exposed_ns(std::string_view text, const std::optional<Rational>& rate) {
  constexpr Names kSpeed{"Shutter Speed(s)", {}};
  if (const auto ns = nanoseconds(fraction_of(text, kSpeed))) return ns;
  if (const auto ns = fraction_of(text, {"Shutter Type2(nsec)", {"", "", "shutterSpeedNsec"}})) {
    return round_half_up(ns->numerator, ns->denominator);
  }
  if (rate && word_of(text, kSpeed) == "open") {
    // Rounded up, for it never closes.
    const int128 period = static_cast<int128>(rate->denominator) * kSecondNs + rate->numerator - 1;
    return static_cast<std::int64_t>(period / rate->numerator);
  }
  // Exposures a second.
  const auto speed = fraction_of(text, {{}, {"", "", "shutterSpeed"}});
  return speed ? nanoseconds(Rational::of(speed->denominator, speed->numerator)) : std::nullopt;
}

PhotronPictures pictures_of(std::string_view text) {
  constexpr std::string_view kData = "imageDataInfo";
  PhotronPictures pictures;
  pictures.width = number_of(text, {"Image Width", {kData, "resolution", "width"}});
  pictures.height = number_of(text, {"Image Height", {kData, "resolution", "height"}});
  pictures.count = number_of(text, {"Total Frame", {"", "frameInfo", "totalFrame"}});
  pictures.pixel_bits = number_of(text, {"Color Bit", {kData, "colorInfo", "bit"}});
  pictures.colour = word_of(text, {"Color Type", {kData, "colorInfo", "type"}});
  pictures.depth = number_of(text, {"EffectiveBit Depth", {kData, "effectiveBit", "depth"}});
  pictures.side = word_of(text, {"EffectiveBit Side", {kData, "effectiveBit", "side"}});
  pictures.file_format = word_of(text, {"File Format", {"", "imageFileInfo", "fileFormat"}});
  pictures.is_processed = number_of(text, {{}, {"", kData, "applyImageProc"}}) != 0;
  return pictures;
}

std::vector<fs::path> headers_of(const fs::path& pictures) {
  std::vector<fs::path> headers;
  std::error_code error;
  if (fs::is_directory(pictures, error)) {
    for (const auto& entry : fs::directory_iterator(pictures, error)) {
      if (is_photron_header(entry.path())) headers.push_back(entry.path());
    }
    return headers;
  }
  headers = headers_beside(pictures);
  std::erase_if(headers, [&](const fs::path& header) { return !fs::is_regular_file(header, error); });
  return headers;
}

}  // namespace

PhotronHeader parse_photron_header(std::string_view text) {
  PhotronHeader header;
  header.rate = fraction_of(text, {"Record Rate(fps)", {"", "", "recordRate"}});
  header.exposed_ns = exposed_ns(text, header.rate);
  header.step = std::max<std::uint64_t>(number_of(text, {"Save Step", {"", "frameInfo", "skipFrame"}}), 1);
  if (header.rate && header.step > 1) {
    header.rate = Rational::of(header.rate->numerator,
                               header.rate->denominator * static_cast<std::int64_t>(header.step));
  }
  header.device = word_of(text, {"Camera Type", {"", "deviceInfo", "deviceName"}});
  header.pictures = pictures_of(text);
  return header;
}

bool is_photron_header(const fs::path& path) {
  const std::string extension = extension_of(path);
  return extension == ".cih" || extension == ".cihx";
}

std::vector<fs::path> headers_beside(const fs::path& pictures) {
  std::vector<fs::path> headers;
  for (const char* extension : {".cih", ".cihx"}) {
    fs::path header = pictures;
    header.replace_extension(extension);
    if (!is_absent(header)) headers.push_back(std::move(header));
  }
  return headers;
}

PhotronHeader read_photron_header(const fs::path& file) {
  const MappedFile mapped(file);
  const auto bytes = mapped.bytes();
  check_text_bytes(file.string(), bytes.size());
  PhotronHeader header = parse_photron_header(as_text(bytes));
  header.file = file;
  return header;
}

std::optional<PhotronHeader> photron_header_of(const fs::path& pictures) {
  const std::vector<fs::path> headers = headers_of(pictures);
  if (headers.size() != 1) return std::nullopt;
  PhotronHeader header = read_photron_header(headers.front());
  return header.rate ? std::optional(header) : std::nullopt;
}

}  // namespace nutik
