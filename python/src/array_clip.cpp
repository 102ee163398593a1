// Clips that lie in memory or are made picture by picture: NumPy arrays, and iterators of them.
#include <atomic>
#include <cstring>
#include <memory>
#include <utility>

#include "capture/error.hpp"
#include "capture/format.hpp"
#include "parts.hpp"

namespace nutik::python {
namespace {

// An object of Python's, for threads that do not hold its lock.
using Held = std::shared_ptr<py::object>;
Held held(py::object object) {
  return {new py::object(std::move(object)), [](py::object* last) {
            const py::gil_scoped_acquire locked;
            delete last;
          }};
}

class PicturesClip final : public Clip {
 public:
  PicturesClip(ClipInfo info, std::string name, Held iterator)
      : info_(std::move(info)), name_(std::move(name)), iterator_(std::move(iterator)) {}

  [[nodiscard]] const ClipInfo& info() const override { return info_; }

  bool read(std::span<std::byte> raster) override {
    const Held picture = next();
    if (!picture) return false;
    std::memcpy(raster.data(), static_cast<const py::array&>(*picture).data(), raster.size());
    const std::uint32_t white = info_.format.white_code;
    const bool is_last = white == (info_.format.code_bytes == 1 ? 255 : 65'535);
    const std::uint32_t code = is_last ? 0 : largest_code(raster, info_.format.code_bytes);
    if (code > white)
      throw InputError(format("{}: picture {} has the code {}, above white, {}", name_, taken_, code, white),
                       {Setting::white_code});
    ++taken_;
    return true;
  }

 private:
  // An array without gaps, which is a copy only where it has some; none at the end.
  [[nodiscard]] Held next() const {
    const py::gil_scoped_acquire locked;
    const auto given = py::reinterpret_steal<py::object>(PyIter_Next(iterator_->ptr()));
    if (!given && PyErr_Occurred() != nullptr) throw py::error_already_set();
    if (!given) return {};
    const auto picture = py::array::ensure(given, py::array::c_style);
    if (!picture) throw py::error_already_set();
    return held(picture);
  }

  ClipInfo info_;
  std::string name_;
  Held iterator_;
  std::uint64_t taken_ = 0;
};

}  // namespace

OpenClip open_pictures(const py::object& pictures, ClipInfo info, std::string name) {
  return [pictures = held(pictures), was_open = std::make_shared<std::atomic_flag>(), info = std::move(info),
          name = std::move(name)] {
    const py::gil_scoped_acquire locked;
    auto iterator = py::reinterpret_steal<py::object>(PyObject_GetIter(pictures->ptr()));
    if (!iterator) throw py::error_already_set();
    if (was_open->test_and_set() && iterator.is(*pictures))
      throw UsageError(format("{} can be read once, and what is asked for reads it twice; pass an array", name));
    return std::make_unique<PicturesClip>(info, name, held(std::move(iterator)));
  };
}

}  // namespace nutik::python
