#include "session/requests/output_request.hpp"

#include "capture/format.hpp"

namespace nutik {
namespace {

// Throws UsageError where codes were asked for that such values are not.
OutputFormat format_of(const OutputRequest& request, ValueType type, const CaptureFormat& capture) {
  OutputFormat format;
  format.type = type;
  format.white_code = type == ValueType::code16 ? 65'535 : 255;
  const auto* const stated = request.transfer ? std::get_if<Transfer>(&*request.transfer) : nullptr;
  const bool keeps_codes = request.transfer && stated == nullptr;
  if (!holds_codes(type)) {
    if (keeps_codes || (stated != nullptr && !stated->is_linear())) {
      throw UsageError("floating point holds light itself, which is linear; leave out how codes are made",
                       {Setting::out_transfer});
    }
    return format;
  }
  if (!keeps_codes) format.transfer = stated != nullptr ? *stated : Transfer::srgb();
  if (keeps_codes && type == code_type(capture)) format.white_code = capture.white_code;
  return format;
}

}  // namespace

std::variant<Transfer, SourceCodes> parse_out_transfer(std::string_view text) {
  if (text == "source") return SourceCodes{};
  const std::string choices = "choose srgb, bt709, linear, gamma:G (as in gamma:2.2) or source";
  try {
    const Transfer transfer = Transfer::parse(text);
    if (transfer.reference_white() == 1.0) return transfer;
  } catch (const UsageError&) {
    throw UsageError(format("transfer '{}' is not known for codes that are made; {}", text, choices),
                     {Setting::out_transfer});
  }
  throw UsageError(format("codes of {} are read and not made; {}", text, choices), {Setting::out_transfer});
}

FileWishes file_wishes(const OutputRequest& request) {
  const bool measures = request.depth == Depth::bits16 ||
                        (request.transfer && std::holds_alternative<SourceCodes>(*request.transfer));
  return {request.quality.value_or(FileWishes::kDefaultQuality), request.depth == Depth::half,
          !request.keep_pixels && !measures};
}

void check_quality(const OutputRequest& request, const std::filesystem::path& output) {
  if (!request.quality || is_lossy_name(output)) return;
  throw UsageError(
      format("a quality is one of .jpg pictures, and {} is none; leave it out", output.string()),
      {Setting::quality});
}

OutputFormat output_format(const OutputRequest& request, const std::filesystem::path& output, ValueType type,
                           const CaptureFormat& capture) {
  check_quality(request, output);
  OutputFormat chosen = format_of(request, type, capture);
  if (request.negative && !holds_codes(type)) {
    throw UsageError(
        Advice{format("`negative` says what codes make of light below 0, and {} holds floating point, which "
                      "keeps it; leave it out",
                      output.string())});
  }
  chosen.negative = request.negative.value_or(NegativeLight::saturate);
  chosen.is_half = request.depth == Depth::half;
  chosen.maps_bounds = request.bounds.has_value();
  return chosen;
}

OutputFormat output_format(const OutputRequest& request, const std::filesystem::path& output,
                           const CaptureFormat& capture) {
  return output_format(request, output,
                       value_type_for(output, request.depth, code_type(capture), capture.shape.channels),
                       capture);
}

OutputFormat output_format(const OutputRequest& request, const CaptureFormat& capture) {
  const ValueType type = !request.depth                   ? code_type(capture)
                         : request.depth == Depth::bits8  ? ValueType::code8
                         : request.depth == Depth::bits16  ? ValueType::code16
                         : request.depth == Depth::doubled ? ValueType::light64
                                                           : ValueType::light32;
  return output_format(request, "a picture of light", type, capture);
}

std::string codes_text(const CaptureFormat& capture, const OutputFormat& output) {
  if (!holds_codes(output.type)) return {};
  const bool is_scaled = output.type == code_type(capture) && output.white_code != capture.white_code;
  const CodeMaking shown = CodeMaking::of(capture, output);
  const bool is_converted = capture.shape.channels == 3 && shown.primaries != capture.primaries;
  if (shown.transfer == capture.transfer && !is_scaled && !is_converted) return {};
  const auto codes = [&](const Transfer& transfer, std::uint32_t white_code, Primaries primaries) {
    return transfer.text() + (is_converted ? format(" in {}", to_text(primaries)) : std::string()) +
           (is_scaled ? format(" with white {}", white_code) : std::string());
  };
  return format(", codes {} (the capture's: {})", codes(shown.transfer, output.white_code, shown.primaries),
                codes(capture.transfer, capture.white_code, capture.primaries));
}

}  // namespace nutik
