// Pictures, which NumPy looks at where they lie.
#include "media/writers/picture_writer.hpp"

#include <pybind11/stl.h>

#include "parts.hpp"
#include "session/output_check.hpp"
#include "session/requests/output_request.hpp"

namespace nutik::python {

std::vector<py::ssize_t> axes_of(const Shape& shape) {
  std::vector<py::ssize_t> axes{static_cast<py::ssize_t>(shape.height),
                                static_cast<py::ssize_t>(shape.width)};
  if (shape.channels > 1) axes.push_back(static_cast<py::ssize_t>(shape.channels));
  return axes;
}

py::array view_of(const py::dtype& type, std::vector<py::ssize_t> shape, const void* values,
                  py::handle owner) {
  py::array view(type, std::move(shape), values, owner);
  view.attr("flags").attr("writeable") = false;
  return view;
}

namespace {

py::dtype dtype_of(ValueType type) {
  switch (type) {
    case ValueType::code8: return py::dtype::of<std::uint8_t>();
    case ValueType::code16: return py::dtype::of<std::uint16_t>();
    case ValueType::light32: return py::dtype::of<float>();
    case ValueType::light64: return py::dtype::of<double>();
  }
  return {};
}

py::array values(const py::object& self) {
  const Picture& picture = self.cast<const HeldPicture&>().picture;
  return view_of(dtype_of(picture.type), axes_of(picture.shape), picture.bytes.data(), self);
}

py::buffer_info buffer_of(HeldPicture& held) {
  const py::dtype type = dtype_of(held.picture.type);
  std::vector<py::ssize_t> shape = axes_of(held.picture.shape), strides(shape.size());
  py::ssize_t stride = type.itemsize();
  for (std::size_t axis = shape.size(); axis-- > 0;) {
    strides[axis] = stride;
    stride *= shape[axis];
  }
  constexpr bool kReadOnly = true;
  const auto dimensions = static_cast<py::ssize_t>(shape.size());
  return {
      held.picture.bytes.data(), type.itemsize(), std::string(1, type.char_()), dimensions, std::move(shape),
      std::move(strides),        kReadOnly};
}

void write(const HeldPicture& held, const std::string& path, std::optional<int> quality) {
  check_output(path, OutputKind::picture, {});
  OutputRequest request;
  request.quality = quality;
  check_quality(request, path);
  const py::gil_scoped_release released;
  write_picture(path, held.picture, {}, file_wishes(request));
}

}  // namespace

void bind_pictures(py::module_& module) {
  py::class_<HeldPicture>(module, "Picture", py::buffer_protocol())
      .def_buffer(&buffer_of)
      .def("values", &values)
      .def("write", &write, py::arg("path"), py::arg("quality"))
      .def_property_readonly("figures", [](const HeldPicture& held) { return held.figures; });
}

}  // namespace nutik::python
