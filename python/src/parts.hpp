// What the module's parts have in common: the values that Python holds, and each part's own share of the module.
#pragma once

#include <pybind11/numpy.h>
#include <pybind11/pybind11.h>

#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "exposure/mask.hpp"
#include "render/render_plan.hpp"
#include "session/session.hpp"
#include "settings.hpp"

namespace nutik::python {

namespace py = pybind11;

// A session, by the name that messages call its capture.
struct OpenCapture {
  std::string name;
  std::unique_ptr<Session> session;
};

// A picture that NumPy looks at where it lies, and what is known of it.
struct HeldPicture {
  Picture picture;
  py::dict figures;
};

// A gain function, and a mask, which do not change.
struct HeldFunction {
  GainFunction function;
};
struct HeldMask {
  Shared<Mask> mask;
};

using HeldFunctions = std::map<std::uint8_t, HeldFunction>;

[[nodiscard]] inline FunctionSet set_of(const HeldFunctions& functions) {
  FunctionSet set;
  for (const auto& [tag, held] : functions) set.emplace(tag, held.function);
  return set;
}
[[nodiscard]] inline HeldFunctions held_functions(const FunctionSet& functions) {
  HeldFunctions held;
  for (const auto& [tag, function] : functions) held.emplace(tag, HeldFunction{function});
  return held;
}

// A copy, of the stated shape.
template <typename Value>
[[nodiscard]] py::array_t<Value> array_of(const std::vector<Value>& values, std::vector<py::ssize_t> shape) {
  return py::array_t<Value>(std::move(shape), values.data());
}
template <typename Value>
[[nodiscard]] py::array_t<Value> array_of(const std::vector<Value>& values) {
  return array_of(values, {static_cast<py::ssize_t>(values.size())});
}

[[nodiscard]] py::dtype dtype_of(ValueType type);
// [height, width] or [height, width, 3].
[[nodiscard]] std::vector<py::ssize_t> axes_of(const Shape& shape);
// Memory of `owner`, which lives as long as what NumPy makes of it; nobody writes there.
[[nodiscard]] py::array view_of(const py::dtype& type, std::vector<py::ssize_t> shape, const void* values,
                                py::handle owner);

// An exposure as render, trace and solve are asked for it; functions and mask may be None.
struct AskedExposure {
  std::optional<HeldFunctions> functions;
  std::optional<HeldMask> mask;
  Options options;
};
[[nodiscard]] ExposureRequest exposure_request(const AskedExposure& asked);
// How values are stored: `dtype`, `transfer`, `negative`.
[[nodiscard]] OutputFormat output_of(const Settings& settings, const CaptureFormat& capture);
[[nodiscard]] py::dict figures_of(const ExposedPicture& exposed);

void bind_commands(py::module_& module);
void bind_captures(py::module_& module);
void bind_functions(py::module_& module);
void bind_masks(py::module_& module);
void bind_pictures(py::module_& module);
void bind_rendering(py::module_& module);
void bind_tracing(py::module_& module);
void bind_studies(py::module_& module);

}  // namespace nutik::python
