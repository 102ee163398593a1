#include "media/photron_header.hpp"

#include <string>
#include <system_error>
#include <vector>

#include "capture/error.hpp"
#include "media/extension.hpp"
#include "system/mapped_file.hpp"

namespace nutik {
namespace {

namespace fs = std::filesystem;

// The number behind a name: `Record Rate(fps) : 30000`, `<recordRate>30000</recordRate>`.
std::optional<Rational> number_behind(std::string_view text, std::string_view name) {
  const auto at = text.find(name);
  if (at == std::string_view::npos) return std::nullopt;
  constexpr std::string_view kBetween = " \t:", kNumber = "0123456789./";
  const std::string_view rest = text.substr(at + name.size());
  const auto begin = rest.find_first_not_of(kBetween);
  if (begin == std::string_view::npos) return std::nullopt;
  const std::string_view number = rest.substr(begin, rest.find_first_not_of(kNumber, begin) - begin);
  try {
    const Rational value = Rational::parse(number, name);
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

bool is_header(const fs::path& path) {
  const std::string extension = extension_of(path);
  return extension == ".cih" || extension == ".cihx";
}

std::vector<fs::path> headers_of(const fs::path& pictures) {
  std::vector<fs::path> headers;
  std::error_code error;
  if (fs::is_directory(pictures, error)) {
    for (const auto& entry : fs::directory_iterator(pictures, error)) {
      if (is_header(entry.path())) headers.push_back(entry.path());
    }
    return headers;
  }
  for (const char* extension : {".cih", ".cihx"}) {
    fs::path header = pictures;
    header.replace_extension(extension);
    if (fs::is_regular_file(header, error)) headers.push_back(header);
  }
  return headers;
}

}  // namespace

PhotronHeader parse_photron_header(std::string_view text) {
  PhotronHeader header;
  header.rate = number_behind(text, "Record Rate(fps)");
  header.exposed_ns = nanoseconds(number_behind(text, "Shutter Speed(s)"));
  if (!header.rate) header.rate = number_behind(text, "<recordRate>");
  if (header.exposed_ns) return header;
  if (const auto ns = number_behind(text, "<shutterSpeedNsec>")) {
    header.exposed_ns = round_half_up(ns->numerator, ns->denominator);
  } else if (const auto speed = number_behind(text, "<shutterSpeed>")) {
    header.exposed_ns = nanoseconds(Rational::of(speed->denominator, speed->numerator));
  }
  return header;
}

std::optional<PhotronHeader> photron_header_of(const fs::path& pictures) {
  const std::vector<fs::path> headers = headers_of(pictures);
  if (headers.size() != 1) return std::nullopt;
  const MappedFile mapped(headers.front());
  const auto bytes = mapped.bytes();
  PhotronHeader header = parse_photron_header({reinterpret_cast<const char*>(bytes.data()), bytes.size()});
  header.file = headers.front();
  return header.rate ? std::optional(header) : std::nullopt;
}

}  // namespace nutik
