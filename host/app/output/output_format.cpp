#include "app/output/output_format.hpp"

#include "media/picture_writer.hpp"

namespace nutik::app {

OutputFormat output_format(const Options& options, const std::filesystem::path& output,
                           const CaptureFormat& capture) {
  const std::optional<Depth> wish = options.depth ? std::optional(parse_depth(*options.depth)) : std::nullopt;
  const ValueType usual = capture.code_bytes == 1 ? ValueType::code8 : ValueType::code16;
  OutputFormat format;
  format.type = value_type_for(output, wish, usual, capture.shape.channels);
  // A picture of the capture's own depth has the capture's codes; another depth its full range.
  format.white_code = format.type == usual               ? capture.white_code
                      : format.type == ValueType::code16 ? 65'535
                                                         : 255;
  return format;
}

}  // namespace nutik::app
