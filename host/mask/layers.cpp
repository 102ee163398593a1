#include "mask/layers.hpp"

#include <array>
#include <utility>
#include <vector>

#include "capture/error.hpp"
#include "capture/format.hpp"
#include "mask/whole_shares.hpp"

namespace nutik {
namespace {

double share_at(const MaskLayer& layer, std::uint64_t pixel) {
  const Picture& picture = layer.picture;
  const double code = picture.type == ValueType::code8 ? picture.values<std::uint8_t>()[pixel]
                                                       : picture.values<std::uint16_t>()[pixel];
  return code / picture.white_code;
}

void check_shape(const MaskLayer& layer, const MaskLayer& first) {
  const Shape& shape = layer.picture.shape;
  if (shape.channels != 1 || !holds_codes(layer.picture.type)) {
    throw InputError(
        format("{} is a picture of {} channels; a layer of a mask is grey, and its white says that M{} has "
               "all of a pixel",
               layer.name, shape.channels, layer.tag));
  }
  const Shape& wanted = first.picture.shape;
  if (shape == wanted) return;
  throw InputError(format("{} has {} x {} pixels and {} has {} x {}; layers of a mask have one size",
                          layer.name, shape.width, shape.height, first.name, wanted.width, wanted.height));
}

[[noreturn]] void refuse(std::span<const MaskLayer> layers, std::uint64_t count, std::uint64_t first,
                         double sum) {
  std::string shares;
  for (const MaskLayer& layer : layers) {
    const double share = share_at(layer, first);
    if (share > 0.0) shares += format("{}{} {:.4g}", shares.empty() ? "" : ", ", layer.name, share);
  }
  const std::uint32_t width = layers[0].picture.shape.width;
  throw InputError(
      format("the layers of the mask come to more than all of {} pixel{}: to {:.4g} at {},{} ({}); darken "
             "them where they overlap, so that they come to 1 at most",
             count, count == 1 ? "" : "s", sum, first % width, first / width, shares));
}

}  // namespace

Mask mask_of_layers(std::span<const MaskLayer> layers, std::uint8_t rest, const ReportedProgress& progress) {
  double rounding = 0x1p-30;  // of the sums here; and of each layer half a code
  for (const MaskLayer& layer : layers) {
    check_shape(layer, layers[0]);
    rounding += 0.5 / layer.picture.white_code;
  }
  const Shape& shape = layers[0].picture.shape;
  Mask mask = Mask::uniform(shape.width, shape.height, rest);
  std::uint64_t too_much = 0, first_too_much = 0;
  double first_sum = 0.0;
  for (std::uint64_t pixel = 0; pixel < shape.pixel_count(); ++pixel) {
    if (progress && pixel % shape.width == 0) progress(pixel / shape.width, shape.height);
    std::array<double, kMaskValues> shares{};
    double sum = 0.0;
    for (const MaskLayer& layer : layers) {
      const double share = share_at(layer, pixel);
      shares[layer.tag] += share;
      sum += share;
    }
    if (sum > 1.0 + rounding && too_much++ == 0) {
      first_too_much = pixel;
      first_sum = sum;
    }
    if (sum < 1.0) shares[rest] += 1.0 - sum;
    put_shares(mask, pixel, whole_shares(shares));
  }
  if (too_much > 0) refuse(layers, too_much, first_too_much, first_sum);
  return mask;
}

Picture layer_of(const Mask& mask, std::uint8_t tag) {
  Picture layer({mask.width, mask.height, 1}, ValueType::code16, kWholeShare);
  const auto codes = layer.values<std::uint16_t>();
  for (std::uint64_t pixel = 0; pixel < mask.tags.size(); ++pixel) {
    codes[pixel] = mask.tags[pixel] == tag ? kWholeShare : 0;
  }
  for (std::size_t i = 0; i < mask.mixed.pixels().size(); ++i) {
    const auto shares = mask.mixed.shares(i);
    const auto found = std::ranges::find(shares, tag, &Share::of);
    codes[mask.mixed.pixels()[i]] = found == shares.end() ? std::uint16_t{0} : found->size;
  }
  return layer;
}

}  // namespace nutik
