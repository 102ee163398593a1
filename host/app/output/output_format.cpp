#include "app/output/output_format.hpp"

#include "capture/error.hpp"
#include "capture/format.hpp"
#include "media/picture_writer.hpp"

namespace nutik::app {
namespace {

NegativeLight parse_negative_light(const std::string& text) {
  if (text == "saturate") return NegativeLight::saturate;
  if (text == "offset") return NegativeLight::offset;
  if (text == "abs") return NegativeLight::absolute;
  throw UsageError(format("--negative {} is not known; choose saturate, offset or abs", text));
}

}  // namespace

NegativeLight negative_light(const Options& options, ValueType type, const std::filesystem::path& output) {
  if (!options.negative) return NegativeLight::saturate;
  const NegativeLight negative = parse_negative_light(*options.negative);
  if (holds_codes(type)) return negative;
  throw UsageError(
      format("--negative says what codes make of light below 0, and {} holds floating point, which "
             "keeps it; leave --negative out",
             output.string()));
}

OutputFormat output_format(const Options& options, const std::filesystem::path& output,
                           const CaptureFormat& capture) {
  const std::optional<Depth> wish = options.depth ? std::optional(parse_depth(*options.depth)) : std::nullopt;
  const ValueType usual = capture.code_bytes == 1 ? ValueType::code8 : ValueType::code16;
  OutputFormat chosen;
  chosen.type = value_type_for(output, wish, usual, capture.shape.channels);
  // A picture of the capture's own depth has the capture's codes; another depth its full range.
  chosen.white_code = chosen.type == usual               ? capture.white_code
                      : chosen.type == ValueType::code16 ? 65'535
                                                         : 255;
  chosen.negative = negative_light(options, chosen.type, output);
  return chosen;
}

}  // namespace nutik::app
