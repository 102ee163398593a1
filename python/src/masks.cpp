// Masks: tags, and shares of them, as arrays.
#include <algorithm>

#include "capture/error.hpp"
#include "capture/format.hpp"
#include "mask/layers.hpp"
#include "parts.hpp"
#include "session/requests/function_input.hpp"

namespace nutik::python {
namespace {

template <typename Code>
using Codes = py::array_t<Code, py::array::c_style | py::array::forcecast>;

template <typename Code>
Picture picture_of(const Codes<Code>& codes, ValueType type, std::uint32_t white) {
  if (codes.ndim() != 2 || codes.size() == 0)
    throw UsageError("a mask is an array of two axes, its height and its width, none of them empty");
  Picture picture({static_cast<std::uint32_t>(codes.shape(1)), static_cast<std::uint32_t>(codes.shape(0)), 1},
                  type, white);
  std::copy_n(codes.data(), codes.size(), picture.values<Code>().begin());
  return picture;
}

HeldMask of_tags(const Codes<std::uint8_t>& tags) {
  return HeldMask(Mask::from_picture(picture_of(tags, ValueType::code8, 255)));
}

HeldMask of_layers(const std::map<std::uint8_t, Codes<std::uint16_t>>& shares, std::uint8_t rest,
                   const py::object& progress) {
  if (shares.empty()) throw UsageError("a mask of layers has one at least");
  std::vector<MaskLayer> layers;
  for (const auto& [tag, codes] : shares)
    layers.push_back({tag, format("layer {}", tag), picture_of(codes, ValueType::code16, kWholeShare)});
  return without_lock(
      [&](const Stopping& stopping) { return HeldMask(mask_of_layers(layers, rest, stopping.progress())); }, progress);
}

HeldMask read_mask(const std::string& path, std::uint8_t rest) {
  const Unlocked released;
  return HeldMask(read_layered_mask_input(path, rest));
}

HeldMask feathered_mask(const HeldMask& held, const std::string& feather, const py::object& progress) {
  const Feather how = Feather::parse(feather);
  if (held->is_soft())
    throw UsageError("feather= blends a mask of tags along its edges; one of layers says itself how it is blended");
  return without_lock(
      [&](const Stopping& stopping) { return HeldMask(feathered(*held, how, stopping.progress())); }, progress);
}

Axes axes(const Mask& mask) { return axes_of({mask.width, mask.height, 1}); }

py::array tags(const py::object& self) {
  const Mask& mask = *self.cast<const HeldMask&>();
  return view_of(py::dtype::of<std::uint8_t>(), axes(mask), mask.tags.data(), self);
}

py::array_t<std::uint16_t> share(const HeldMask& held, std::uint8_t tag) {
  return py::array_t<std::uint16_t>(axes(*held), layer_of(*held, tag).values<std::uint16_t>().data());
}

std::vector<std::uint8_t> tags_in_use(const HeldMask& held) {
  std::vector<std::uint8_t> used;
  for (const MaskRegion& region : regions_of(*held)) used.push_back(region.tag);
  return used;
}

}  // namespace

void bind_masks(py::module_& module) {
  py::class_<HeldMask>(module, "Mask")
      .def(py::init(&of_tags), "tags"_a)
      .def_static("of_layers", &of_layers, "shares"_a, "rest"_a, "progress"_a)
      .def_static("read", &read_mask, "path"_a, "rest"_a)
      .def("feathered", &feathered_mask, "feather"_a, "progress"_a)
      .def("tags", &tags)
      .def("share", &share, "tag"_a)
      .def("tags_in_use", &tags_in_use)
      .def("is_soft", [](const HeldMask& held) { return held->is_soft(); });
  module.attr("WHOLE_SHARE") = kWholeShare;
}

}  // namespace nutik::python
