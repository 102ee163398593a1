#include "app/output/output_format.hpp"

#include "session/error.hpp"
#include "session/format.hpp"
#include "session/pictures.hpp"

namespace nutik::app {
namespace {

std::optional<Depth> stated_depth(const Options& options) {
  return options.depth ? std::optional(parse_depth(*options.depth)) : std::nullopt;
}

// A picture of the capture's own depth has the capture's codes; another depth its full range.
OutputFormat format_of(ValueType type, const CaptureFormat& capture) {
  OutputFormat format;
  format.type = type;
  format.white_code = type == code_type(capture)  ? capture.white_code
                      : type == ValueType::code16 ? 65'535
                                                  : 255;
  return format;
}

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
  OutputFormat chosen = format_of(
      value_type_for(output, stated_depth(options), code_type(capture), capture.shape.channels), capture);
  chosen.negative = negative_light(options, chosen.type, output);
  return chosen;
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
