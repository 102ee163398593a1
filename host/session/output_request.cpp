#include "session/output_request.hpp"

#include "capture/format.hpp"

namespace nutik {
namespace {

// A picture of the capture's own depth has the capture's codes; another depth its full range.
OutputFormat format_of(ValueType type, const CaptureFormat& capture) {
  OutputFormat format;
  format.type = type;
  format.white_code = type == code_type(capture)  ? capture.white_code
                      : type == ValueType::code16 ? 65'535
                                                  : 255;
  return format;
}

}  // namespace

LightIsKept::LightIsKept(const std::filesystem::path& file)
    : UsageError(format("{} holds floating point, which keeps light below 0", file.string())), output(file) {}

NegativeLight negative_light(const OutputRequest& request, ValueType type,
                             const std::filesystem::path& output) {
  if (request.negative && !holds_codes(type)) throw LightIsKept(output);
  return request.negative.value_or(NegativeLight::saturate);
}

OutputFormat output_format(const OutputRequest& request, const std::filesystem::path& output,
                           const CaptureFormat& capture) {
  OutputFormat chosen =
      format_of(value_type_for(output, request.depth, code_type(capture), capture.shape.channels), capture);
  chosen.negative = negative_light(request, chosen.type, output);
  return chosen;
}

OutputFormat output_format(const OutputRequest& request, const CaptureFormat& capture) {
  const ValueType type = !request.depth                   ? code_type(capture)
                         : request.depth == Depth::bits8  ? ValueType::code8
                         : request.depth == Depth::bits16 ? ValueType::code16
                                                          : ValueType::light32;
  return format_of(type, capture);
}

}  // namespace nutik
