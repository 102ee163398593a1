#include "features/masks/comparable_codes.hpp"

#include <algorithm>

#include "capture/error.hpp"
#include "capture/format.hpp"
#include "render/code_scale.hpp"

namespace nutik {
namespace {

Picture light_of(const Picture& picture, const Transfer& transfer) {
  const auto bytes = static_cast<std::uint32_t>(value_bytes(picture.type));
  const std::vector<double> light_of_code = transfer.light_of_all_codes(picture.white_code, bytes);
  Picture light(picture.shape, ValueType::light64, 0);
  with_codes(bytes, picture.bytes.data(), [&](const auto* codes) {
    std::transform(codes, codes + picture.shape.value_count(), light.values<double>().begin(),
                   [&](auto code) { return light_of_code[code]; });
  });
  return light;
}

std::string codes_text(const Transfer& transfer, Primaries primaries, const Shape& shape) {
  return format("{}{}", transfer.text(), shape.channels == 1 ? std::string() : format(" in {}", to_text(primaries)));
}

}  // namespace

std::pair<Shared<Picture>, Shared<Picture>> comparable_codes(Shared<Picture> captured, const CaptureFormat& capture,
                                                             const NamedPicture& named) {
  const Picture& picture = *named.picture;
  const bool has_its_primaries = picture.shape.channels == 1 || picture.primaries == capture.primaries ||
                                 (named.holds_light && !named.says_primaries);
  const bool is_own = !picture.transfer || (*picture.transfer == capture.transfer && has_its_primaries);
  OutputFormat own;
  own.type = code_type(capture);
  own.white_code = capture.white_code;
  if (is_own && !named.holds_light && picture.type == own.type && picture.white_code == own.white_code)
    return {std::move(captured), named.picture};

  // How the file's codes were made: of light as it is, of the capture's own kind, or to be seen.
  CaptureFormat made_of = capture;
  if (named.holds_light) made_of.transfer = Transfer::linear();
  OutputFormat made{picture.type, picture.white_code};
  if (!named.holds_light && !is_own) made.transfer = picture.transfer;
  const bool is_to_be_seen = made.transfer && made.transfer->reference_white() == 1.0 &&
                             (picture.shape.channels == 1 || picture.primaries == Primaries::bt709);
  if (made.transfer ? !is_to_be_seen : picture.transfer && !has_its_primaries) {
    throw InputError(
        format("{} holds {}, the capture {}, and nothing tells how the one was made of the other", named.name,
               codes_text(*picture.transfer, picture.primaries, picture.shape),
               codes_text(capture.transfer, capture.primaries, picture.shape)),
        Advice{"; write it in the capture's own codes: `out-transfer source`"});
  }
  const CodeMaking making = CodeMaking::of(made_of, made);
  const CodeScale scale(capture.transfer, own);
  const auto to_own = [&](const Picture& codes) {
    Picture light = light_of(codes, making.transfer);
    for (double& value : light.values<double>()) value *= making.white_light;
    return Shared(encoded(light, scale, own, true));
  };
  Saturation ignored;
  return {to_own(stored(light_of(*captured, capture.transfer), made_of, made, ignored, true)), to_own(picture)};
}

std::string silence_note(const CaptureFormat& capture, const NamedPicture& named) {
  if (named.picture->transfer || capture.transfer == Transfer::srgb()) return {};
  return format("{} does not say what its codes stand for: they are taken for {}, as what is beside it; a PNG, TIFF or "
                "OpenEXR says it",
                named.name, capture.transfer.text());
}

}  // namespace nutik
