// Pictures, which NumPy looks at where they lie.
#include "media/writers/picture_writer.hpp"

#include <cstring>

#include "capture/error.hpp"
#include "capture/light_codes.hpp"
#include "parts.hpp"
#include "session/output_check.hpp"
#include "session/requests/output_request.hpp"

namespace nutik::python {

py::dtype dtype_of(ValueType type) {
  switch (type) {
    case ValueType::code8: return py::dtype::of<std::uint8_t>();
    case ValueType::code16: return py::dtype::of<std::uint16_t>();
    case ValueType::light32: return py::dtype::of<float>();
    case ValueType::light64: return py::dtype::of<double>();
  }
  return {};
}

Axes axes_of(const Shape& shape, Axes first) {
  first.insert(first.end(), {static_cast<py::ssize_t>(shape.height), static_cast<py::ssize_t>(shape.width)});
  if (shape.channels > 1) first.push_back(static_cast<py::ssize_t>(shape.channels));
  return first;
}

py::array view_of(const py::dtype& type, Axes shape, const void* values, py::handle owner) {
  py::array view(type, std::move(shape), values, owner);
  view.attr("flags").attr("writeable") = false;
  return view;
}

namespace {

py::array values(const py::object& self) {
  const Picture& picture = self.cast<const HeldPicture&>().picture;
  return view_of(dtype_of(picture.type), axes_of(picture.shape), picture.bytes.data(), self);
}

// Looks for Ctrl-C between the parts that are written.
void write(const HeldPicture& held, const std::string& path, std::optional<int> quality, bool keep_pixels) {
  check_output(path, OutputKind::picture, {});
  OutputRequest request;
  request.quality = quality;
  request.keep_pixels = keep_pixels;
  check_quality(request, path);
  without_lock([&](const Stopping& stopping) {
    FileWishes wishes = file_wishes(request);
    wishes.check = [progress = stopping.progress()] { progress(0, 0); };
    write_picture(path, held.picture, {}, wishes);
  });
}

// Light as codes of screens, whose white is the light that the capture's curve has for it.
HeldPicture for_eyes(const HeldPicture& held) {
  const Picture& light = held.picture;
  const Transfer srgb = Transfer::srgb();
  Picture codes(light.shape, ValueType::code8, 255);
  codes.transfer = srgb;
  codes.primaries = light.primaries;
  codes.pixel_aspect = light.pixel_aspect;
  const LightCodes table(srgb, 255);
  const double white = held.figures.contains("reference_white") ? held.figures["reference_white"].cast<double>() : 1.0;
  for (std::uint64_t i = 0; i < light.shape.value_count(); ++i) {
    const double value = light.type == ValueType::light32 ? light.values<float>()[i] : light.values<double>()[i];
    codes.values<std::uint8_t>()[i] = static_cast<std::uint8_t>(value > 0 ? table.code_of(value / white) : 0);
  }
  return {std::move(codes), {}};
}

// All that a picture is, for pickle.
using State = std::tuple<std::array<std::uint32_t, 3>, int, std::uint32_t, std::optional<std::string>, int,
                         std::array<std::int64_t, 2>, std::optional<std::int64_t>, py::dict, py::bytes>;

State state_of(const HeldPicture& held) {
  const Picture& picture = held.picture;
  const auto& [width, height, channels] = picture.shape;
  const auto transfer = picture.transfer ? std::optional(picture.transfer->text()) : std::nullopt;
  return {{width, height, channels}, static_cast<int>(picture.type), picture.white_code, transfer,
          static_cast<int>(picture.primaries), {picture.pixel_aspect.numerator, picture.pixel_aspect.denominator},
          picture.exposed_ns, held.figures,
          py::bytes(reinterpret_cast<const char*>(picture.bytes.data()), picture.bytes.size())};
}

HeldPicture unpickled(const State& state) {
  const auto& [sides, type, white, transfer, primaries, aspect, exposed_ns, figures, bytes] = state;
  Picture picture({sides[0], sides[1], sides[2]}, static_cast<ValueType>(type), white);
  if (transfer) picture.transfer = Transfer::parse(*transfer);
  picture.primaries = static_cast<Primaries>(primaries);
  picture.pixel_aspect = Rational::of(aspect[0], aspect[1]);
  picture.exposed_ns = exposed_ns;
  const std::string_view values(bytes);
  if (values.size() != picture.bytes.size()) throw InputError("a pickled picture has another size than it says");
  std::memcpy(picture.bytes.data(), values.data(), values.size());
  return {std::move(picture), figures};
}

}  // namespace

void bind_pictures(py::module_& module) {
  py::class_<HeldPicture>(module, "Picture")
      .def(py::pickle(&state_of, &unpickled))
      .def("values", &values)
      .def("write", &write, "path"_a, "quality"_a, "keep_pixels"_a)
      .def("for_eyes", &for_eyes)
      .def_readonly("figures", &HeldPicture::figures);
}

}  // namespace nutik::python
