#include "app/output/output_format.hpp"

#include "media/picture_writer.hpp"

namespace nutik::app {
namespace {

std::optional<Depth> stated_depth(const Options& options) {
  return options.depth ? std::optional(parse_depth(*options.depth)) : std::nullopt;
}

// A picture of the capture's own depth has the capture's codes; another depth its full range.
OutputFormat format_of(ValueType type, const CaptureFormat& capture) {
  return {type, type == code_type(capture) ? capture.white_code : type == ValueType::code16 ? 65'535 : 255};
}

}  // namespace

OutputFormat output_format(const Options& options, const std::filesystem::path& output,
                           const CaptureFormat& capture) {
  return format_of(value_type_for(output, stated_depth(options), code_type(capture), capture.shape.channels),
                   capture);
}

OutputFormat output_format(const Options& options, const CaptureFormat& capture) {
  const std::optional<Depth> depth = stated_depth(options);
  const ValueType type = !depth                   ? code_type(capture)
                         : depth == Depth::bits8  ? ValueType::code8
                         : depth == Depth::bits16 ? ValueType::code16
                                                  : ValueType::light32;
  return format_of(type, capture);
}

}  // namespace nutik::app
