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

// A copy, of the stated shape.
template <typename Value>
[[nodiscard]] py::array_t<Value> array_of(const std::vector<Value>& values, Axes shape) {
  return py::array_t<Value>(std::move(shape), values.data());
}
template <typename Value>
[[nodiscard]] py::array_t<Value> array_of(const std::vector<Value>& values) {
  return array_of(values, {static_cast<py::ssize_t>(values.size())});
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

  [[nodiscard]] RenderControl control_of(const Stopping& stopping) const {
    RenderControl stopped = control;
    stopped.stop = stopping.stop;
    stopped.progress = stopping.progress();
    return stopped;
  }
};
// How values are stored: `dtype`, `transfer`, `negative`.
[[nodiscard]] OutputFormat output_of(const Settings& settings, const CaptureFormat& capture);
[[nodiscard]] py::dict figures_of(const ExposedPicture& exposed);
[[nodiscard]] py::object saturated_of(ValueType type, const Saturation& saturation);

// What its owner says of the codes and times of pictures that lie in memory, beside a SourceRequest.
struct PictureNotes {
  ClipTiming timing;
  Shape shape;
  std::uint32_t code_bytes = 1;
  std::uint64_t sample_count = 0;                    // 0: an iterator does not say
  std::optional<double> white_light = std::nullopt;  // where codes are light that was rounded to the nearest
};
// An array [samples, height, width(, 3)] of uint8 or uint16, however it is strided, which is read where it lies,
// without Python's lock, and lives as long as the clip.
[[nodiscard]] OpenClip open_array(const py::array& pictures, PictureNotes notes, ClipOptions options, std::string name);
// Such pictures one by one, all of one shape; to be opened once. It is called with the lock held, on the thread that
// reads, and what it raises comes back to the caller.
[[nodiscard]] OpenClip open_iterator(const py::iterator& pictures, PictureNotes notes, ClipOptions options,
                                     std::string name);

void bind_errors(py::module_& module);
void bind_commands(py::module_& module);
void bind_captures(py::module_& module);
void bind_functions(py::module_& module);
void bind_masks(py::module_& module);
void bind_pictures(py::module_& module);
void bind_rendering(py::module_& module);
void bind_tracing(py::module_& module);
void bind_studies(py::module_& module);

}  // namespace nutik::python
