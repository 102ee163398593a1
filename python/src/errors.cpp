#include "errors.hpp"

#include <exception>
#include <filesystem>
#include <new>

#include "session/below/capture.hpp"
#include "session/below/format.hpp"
#include "session/clips/alignment.hpp"
#include "session/clips/clip_source.hpp"
#include "session/clips/measured_noise.hpp"
#include "session/devices.hpp"
#include "session/making/study_request.hpp"
#include "session/memory_budget.hpp"
#include "session/requests/output_request.hpp"
#include "system/interruption.hpp"

namespace nutik::python {

namespace py = pybind11;

namespace {

// Kept for as long as the interpreter runs: translators have no other place to look.
struct ErrorTypes {
  PyObject *error, *usage, *input, *device, *output, *memory;
};
ErrorTypes& types() {
  static ErrorTypes types{};
  return types;
}

std::string message_text(const std::exception& error) {
  const std::string message = error.what();
  if (const auto* memory = dynamic_cast<const MemoryTooLittle*>(&error))
    return format("{}; allow more: memory='{}MB'", message, memory->min_bytes() / 1'000'000 + 1);
  if (const auto* blocks = dynamic_cast<const BlocksTooLong*>(&error)) {
    return format("{} (memory=); use fewer samples a block (block_samples={})", message,
                  blocks->max_samples);
  }
  if (dynamic_cast<const tik::Recoverable*>(&error) != nullptr)
    return message + "; save what is whole with: nutik-cl recover";
  if (dynamic_cast<const ExposuresAreListed*>(&error) != nullptr)
    return message + "; leave shutter_angle= out";
  if (const auto* align = dynamic_cast<const CannotAlign*>(&error)) {
    if (align->way_out == CannotAlign::WayOut::hold)
      return message + "; take a part of the clip, or keep the picture's size (unseen='hold')";
    return format("{}; try {}another picture to align to (align_to=), or a part of the clip", message,
                  align->way_out == CannotAlign::WayOut::homography ? "align='homography', " : "");
  }
  if (const auto* moves = dynamic_cast<const FootageMoves*>(&error)) {
    const char* first = "";
    switch (moves->way_out) {
      case FootageMoves::WayOut::align: first = "an aligned camera (align='rigid'), "; break;
      case FootageMoves::WayOut::deflicker: first = "evened brightness (deflicker=True), "; break;
      case FootageMoves::WayOut::part: break;
    }
    return format("{}; or {}a part that stands still", message, first);
  }
  if (dynamic_cast<const EverythingMoves*>(&error) != nullptr)
    return message + ". A camera that moved stands still with align='rigid'";
  if (dynamic_cast<const LightIsKept*>(&error) != nullptr)
    return "negative= says what codes make of light below 0, and an array of light keeps it; leave it out";
  if (const auto* known = dynamic_cast<const Error*>(&error))
    return message + arguments_text(known->settings());
  return message;
}

void raise(PyObject* type, const Error& error) {
  const py::str text(message_text(error));
  py::list settings;
  for (const Setting setting : error.settings()) settings.append(std::string(argument_of(setting)));
  const py::object raised = py::reinterpret_borrow<py::object>(type)(text);
  raised.attr("settings") = py::tuple(settings);
  PyErr_SetObject(type, raised.ptr());
}

void translate(std::exception_ptr thrown) {
  try {
    std::rethrow_exception(thrown);
  } catch (const MemoryTooLittle& error) {
    raise(types().memory, error);
  } catch (const UsageError& error) {
    raise(types().usage, error);
  } catch (const InputError& error) {
    raise(types().input, error);
  } catch (const DeviceError& error) {
    raise(types().device, error);
  } catch (const OutputError& error) {
    raise(types().output, error);
  } catch (const Cancelled&) {
    PyErr_SetNone(PyExc_KeyboardInterrupt);
  } catch (const Error& error) {
    raise(types().error, error);
  }
}

PyObject* add_type(py::module_& module, const char* name, const py::tuple& bases, const char* doc) {
  const std::string full = std::string("nutik.") + name;
  PyObject* type = PyErr_NewExceptionWithDoc(full.c_str(), doc, bases.ptr(), nullptr);
  if (type == nullptr) throw py::error_already_set();
  module.attr(name) = py::reinterpret_borrow<py::object>(type);
  return type;
}

}  // namespace

std::string_view argument_of(Setting setting) {
  switch (setting) {
    case Setting::automatic_noise: return "noise='auto'";
    case Setting::block_samples: return "block_samples=";
    case Setting::chroma_place: return "chroma_at=";
    case Setting::columns: return "columns=";
    case Setting::contrast: return "contrast=";
    case Setting::count_redrawn: return "count_redrawn=";
    case Setting::crop: return "crop=";
    case Setting::deflicker: return "deflicker=";
    case Setting::deinterlace: return "deinterlace=";
    case Setting::depth: return "dtype=";
    case Setting::end_at_damage: return "as_far_as_it_goes=True";
    case Setting::frame_rate: return "rate=";
    case Setting::from: return "begin=";
    case Setting::matrix: return "matrix=";
    case Setting::normalization: return "normalize=";
    case Setting::out_transfer: return "transfer=";
    case Setting::pixel_aspect: return "pixel_aspect=";
    case Setting::precision: return "precision=";
    case Setting::primaries: return "primaries=";
    case Setting::quality: return "quality=";
    case Setting::range: return "range=";
    case Setting::raw_layout: return "raw=";
    case Setting::renderer: return "renderer=";
    case Setting::scale: return "scale=";
    case Setting::shutter_angle: return "shutter_angle=";
    case Setting::start_picture: return "start_picture=";
    case Setting::tick: return "tick=";
    case Setting::to: return "end=";
    case Setting::transfer: return "transfer=";
    case Setting::unmapped: return "unmapped='zero'";
    case Setting::video_codec: return "video_codec=";
    case Setting::white_code: return "white=";
    case Setting::width: return "width=";
  }
  return {};
}

std::string arguments_text(const std::vector<Setting>& settings) {
  std::string text;
  for (const Setting setting : settings)
    text += format("{}{}", text.empty() ? " (" : ", ", argument_of(setting));
  return text.empty() ? text : text + ")";
}

std::vector<std::string> note_texts(const std::vector<Note>& notes) {
  std::vector<std::string> texts;
  for (const Note& note : notes) texts.push_back(note.text + arguments_text(note.settings));
  return texts;
}

void bind_errors(py::module_& module) {
  const auto base = [](PyObject* type) { return py::reinterpret_borrow<py::object>(type); };
  ErrorTypes& made = types();
  made.error = add_type(module, "Error", py::make_tuple(base(PyExc_Exception)),
                        "What nutik raises. settings: the arguments that would help, as a tuple of str.");
  // Of those that Python code raises.
  py::setattr(made.error, "settings", py::tuple());
  const auto error = base(made.error);
  made.usage =
      add_type(module, "UsageError", py::make_tuple(error, base(PyExc_ValueError)),
               "The request itself makes no sense: arguments that contradict each other, an unknown name.");
  made.input = add_type(module, "InputError", py::make_tuple(error, base(PyExc_ValueError)),
                        "Something that was read is wrong: a clip, a capture, pictures, a mask, a function.");
  made.device = add_type(module, "DeviceError", py::make_tuple(error, base(PyExc_RuntimeError)),
                         "The OpenCL device cannot do it: absent, too small, a failed build.");
  made.output = add_type(module, "OutputError", py::make_tuple(error, base(PyExc_OSError)),
                         "A file cannot be written.");
  made.memory = add_type(module, "MemoryTooLittle", py::make_tuple(base(made.usage), base(PyExc_MemoryError)),
                         "Less memory is allowed than the work takes; the message says the least that does.");
  py::register_exception_translator(translate);
}

}  // namespace nutik::python
