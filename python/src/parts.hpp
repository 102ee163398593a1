// What the module's parts have in common: the values that Python holds, and each part's own share of the module.
#pragma once

#include <pybind11/numpy.h>
#include <pybind11/pybind11.h>
#include <pybind11/stl.h>

#include <cstdint>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "align/alignment.hpp"
#include "exposure/mask.hpp"
#include "features/schema/command_id.hpp"
#include "features/schema/options.hpp"
#include "render/render_plan.hpp"
#include "session/session.hpp"
#include "working.hpp"

namespace nutik::python {

using namespace py::literals;

// A session, by the name that messages call its capture.
struct OpenCapture {
  std::string name;
  std::unique_ptr<Session> session;

  [[nodiscard]] const Timeline& timeline() const { return session->timeline(); }
  [[nodiscard]] const Shape& shape() const { return session->format().shape; }
};

// A picture that NumPy looks at where it lies, and what is known of it.
struct HeldPicture {
  Picture picture;
  py::dict figures;
};

using HeldMask = Shared<Mask>;
using Axes = std::vector<py::ssize_t>;

// A copy, of the stated shape or of one axis.
template <typename Value>
[[nodiscard]] py::array_t<Value> array_of(const std::vector<Value>& values, Axes shape = {}) {
  if (shape.empty()) shape = {static_cast<py::ssize_t>(values.size())};
  return py::array_t<Value>(std::move(shape), values.data());
}

// Bytes that are no UTF-8 become text such as `\xed`.
[[nodiscard]] inline py::str text_of(const std::string& text) {
  return py::reinterpret_steal<py::str>(
      PyUnicode_DecodeUTF8(text.data(), static_cast<py::ssize_t>(text.size()), "backslashreplace"));
}

[[nodiscard]] py::dtype dtype_of(ValueType type);
// [height, width] or [height, width, 3]; behind others, where these are stated.
[[nodiscard]] Axes axes_of(const Shape& shape, Axes first = {});
// Memory of `owner`, which lives as long as what NumPy makes of it; nobody writes there.
[[nodiscard]] py::array view_of(const py::dtype& type, Axes shape, const void* values, py::handle owner);

// What is stated by the names of Python's arguments, each as a word of the command line.
using Settings = std::map<std::string, std::string>;

// As a command's options. Throws UsageError.
[[nodiscard]] Options stated_options(CommandId command, const Settings& settings);

// An exposure as render, trace and solve are asked for it, and how it is computed.
struct AskedExposure {
  ExposureRequest request;
  RenderControl control;
};
// How values are stored: `dtype`, `transfer`, `negative`.
[[nodiscard]] OutputFormat output_of(const Settings& settings, const CaptureFormat& capture);
[[nodiscard]] py::dict figures_of(const ExposedPicture& exposed);
[[nodiscard]] py::object saturated_of(ValueType type, const Saturation& saturation);

void bind_captures(py::module_& module);
void bind_functions(py::module_& module);
void bind_rendering(py::module_& module);
void bind_studies(py::module_& module);

}  // namespace nutik::python
