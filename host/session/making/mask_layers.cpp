#include "session/making/mask_layers.hpp"

#include "capture/error.hpp"
#include "capture/format.hpp"
#include "mask/layers.hpp"
#include "media/writers/picture_writer.hpp"
#include "session/requests/function_input.hpp"

namespace nutik {
namespace {

NumberedName numbered(const std::filesystem::path& name) {
  if (const auto parsed = NumberedName::parse(name.filename().string())) return *parsed;
  throw UsageError(
      format("a soft mask is written as layers, one for each tag, so its name needs a number, as in {}",
             (name.parent_path() / (name.stem().string() + "-%d.png")).string()));
}

}  // namespace

MaskLayers::MaskLayers(const std::filesystem::path& name)
    : name_(name), folder_(name.parent_path()), numbered_(numbered(name)) {}

void MaskLayers::check(std::span<const std::string> inputs, Replacing replacing) const {
  for (std::uint32_t tag = 0; tag < kMaskValues; ++tag) check_mask_output(file(tag), inputs, replacing);
}

void MaskLayers::write(const Mask& mask) const {
  const auto counts = mask.pixels_per_tag();
  for (const auto& [tag, file] : layer_files(name_.string())) {
    if (counts[tag] > 0) continue;
    throw OutputError(
        format("{} is there, and M{} has no pixel in this mask: it would be taken for one of its layers. "
               "Remove it, or choose another name",
               file.string(), tag));
  }
  for (std::size_t tag = 0; tag < counts.size(); ++tag) {
    if (counts[tag] > 0) write_picture(file(tag), layer_of(mask, static_cast<std::uint8_t>(tag)));
  }
}

}  // namespace nutik
