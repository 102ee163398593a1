#include "session/requests/source_request.hpp"

#include "capture/error.hpp"
#include "capture/format.hpp"
#include "system/input_bytes.hpp"
#include "tik/header.hpp"

namespace nutik {

ClipMoment clip_moment(const StatedTime& time, std::string_view what) {
  if (!time.counts_samples()) return {time.nanoseconds(), false};
  if (time.number.denominator != 1) {
    throw UsageError(format("{} {} is not a whole number of pictures", what, time.text()));
  }
  return {time.number.numerator, true};
}

bool SourceRequest::describes_clip() const {
  SourceRequest plain;
  plain.path = path;
  plain.clip.transfer = clip.transfer;  // what codes stand for can be stated of captures, too
  return *this != plain;
}

bool is_tik(const std::filesystem::path& path) {
  const std::string start = first_bytes(is_standard_input(path.string()) ? standard_input_file() : path);
  return tik::looks_like_tik(std::as_bytes(std::span(start))) || path.extension() == ".tik";
}

}  // namespace nutik
