#include "session/requests/source_request.hpp"

#include "capture/error.hpp"
#include "capture/format.hpp"
#include "system/input_bytes.hpp"
#include "system/mapped_file.hpp"

namespace nutik {

ClipMoment clip_moment(const StatedTime& time, std::string_view what) {
  if (!time.counts_samples()) return {time.nanoseconds(), false};
  if (time.number.denominator != 1) {
    throw UsageError(format("{} {} is not a whole number of pictures", what, time.text()));
  }
  return {time.number.numerator, true};
}

std::int64_t tick_ns(const StatedTime& time, std::string_view what) {
  if (!time.counts_samples() && time.nanoseconds() > 0) return time.nanoseconds();
  throw UsageError(format("{} {} is no length of time of 1 ns or more: 100us, 1ms", what, time.text()));
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

std::optional<Shape> known_shape(const std::filesystem::path& path) {
  if (is_standard_input(path.string()) || !is_tik(path)) return std::nullopt;
  try {
    const MappedFile file(path);
    return tik::parse_header(file.bytes(), path.string()).header.capture.shape;
  } catch (const InputError&) {  // it is said when it is opened
    return std::nullopt;
  }
}

void check_stated_transfer(const tik::Header& header, const std::string& name,
                           const std::optional<Transfer>& stated) {
  const Transfer& held = header.capture.transfer;
  if (!stated || Transfer::restated(held, *stated) == held) return;
  const char* const why = header.capture.noise.camera ? "what a camera's noise explains was held as its mean"
                          : header.is_scaled          ? "pictures were scaled"
                          : header.alignment          ? "pictures were moved by fractions of a pixel"
                          : header.made               ? "samples were made between pictures, in light"
                                                      : nullptr;
  if (why == nullptr) return;
  throw UsageError(
      format("{} holds codes that are means of light by {}: {}. By {} that light has other means, and "
             "no code says which; encode the clip again with it",
             name, held.text(), why, stated->text()),
      {Setting::transfer});
}

}  // namespace nutik
