#include "array_clip.hpp"

#include <atomic>
#include <cstring>
#include <memory>
#include <utility>

#include "capture/error.hpp"
#include "capture/format.hpp"

namespace nutik::python {

namespace py = pybind11;

namespace {

// An object of Python's, for threads that do not hold its lock.
using Held = std::shared_ptr<py::object>;
Held held(py::object object) {
  return {new py::object(std::move(object)), [](py::object* last) {
            const py::gil_scoped_acquire locked;
            delete last;
          }};
}

// One picture: where its first value lies, and how far it is from one row, column and channel to the next.
struct Raster {
  const std::byte* first = nullptr;
  py::ssize_t row = 0, column = 0, channel = 0;  // bytes
};

template <typename Code>
void copy_values(const Raster& from, const Shape& shape, std::span<std::byte> to) {
  std::byte* target = to.data();
  for (std::uint32_t y = 0; y < shape.height; ++y) {
    const std::byte* const line = from.first + static_cast<py::ssize_t>(y) * from.row;
    for (std::uint32_t x = 0; x < shape.width; ++x) {
      const std::byte* value = line + static_cast<py::ssize_t>(x) * from.column;
      for (std::uint32_t c = 0; c < shape.channels; ++c, value += from.channel, target += sizeof(Code))
        std::memcpy(target, value, sizeof(Code));
    }
  }
}

void copy_raster(const Raster& from, const PictureNotes& notes, std::span<std::byte> to) {
  const Shape& shape = notes.shape;
  const auto code = static_cast<py::ssize_t>(notes.code_bytes);
  const py::ssize_t pixel = code * shape.channels;
  const bool is_row_whole = from.column == pixel && (shape.channels == 1 || from.channel == code);
  const std::size_t row_bytes = static_cast<std::size_t>(pixel) * shape.width;
  if (is_row_whole) {
    for (std::uint32_t y = 0; y < shape.height; ++y)
      std::memcpy(to.data() + y * row_bytes, from.first + static_cast<py::ssize_t>(y) * from.row, row_bytes);
  } else if (notes.code_bytes == 1) {
    copy_values<std::uint8_t>(from, shape, to);
  } else {
    copy_values<std::uint16_t>(from, shape, to);
  }
}

// Where a picture of `notes.shape` lies in an array whose last axes are its rows, columns and channels.
Raster raster_of(const py::array& array, py::ssize_t rows_axis) {
  const bool has_channels = array.ndim() > rows_axis + 2;
  return {static_cast<const std::byte*>(array.data()), array.strides(rows_axis), array.strides(rows_axis + 1),
          has_channels ? array.strides(rows_axis + 2) : 0};
}

ClipInfo info_of(const PictureNotes& notes, const ClipOptions& options) {
  ClipInfo info;
  info.format.shape = notes.shape;
  info.format.code_bytes = notes.code_bytes;
  info.format.white_code = options.white_code.value_or(notes.code_bytes == 1 ? 255 : 65'535);
  info.timing = notes.timing;
  info.sample_count = notes.sample_count;
  if (notes.white_light) describe_light(info, *notes.white_light);
  describe_stored_codes(info, options, {notes.code_bytes == 1 ? Transfer::srgb() : Transfer::linear()});
  return info;
}

class PicturesClip : public Clip {
 public:
  PicturesClip(PictureNotes notes, const ClipOptions& options, std::string name)
      : notes_(std::move(notes)), info_(info_of(notes_, options)), name_(std::move(name)) {
    const std::uint32_t last = notes_.code_bytes == 1 ? 255 : 65'535;
    if (info_.format.white_code < last) white_code_ = info_.format.white_code;
  }

  [[nodiscard]] const ClipInfo& info() const override { return info_; }

 protected:
  void take(const Raster& picture, std::span<std::byte> raster) {
    copy_raster(picture, notes_, raster);
    if (white_code_) {
      const std::uint32_t code = largest_code(raster, notes_.code_bytes);
      if (code > *white_code_) {
        throw InputError(
            format("{}: picture {} has the code {}, above white, {}", name_, taken_, code, *white_code_),
            {Setting::white_code});
      }
    }
    ++taken_;
  }

  PictureNotes notes_;
  ClipInfo info_;
  std::string name_;
  std::uint64_t taken_ = 0;

 private:
  std::optional<std::uint32_t> white_code_;  // none: no code is larger
};

class ArrayClip final : public PicturesClip {
 public:
  ArrayClip(Held array, Raster first, py::ssize_t stride, const PictureNotes& notes,
            const ClipOptions& options, std::string name)
      : PicturesClip(notes, options, std::move(name)),
        array_(std::move(array)),
        next_(first),
        stride_(stride) {}

  bool read(std::span<std::byte> raster) override {
    if (taken_ == notes_.sample_count) return false;
    take(next_, raster);
    next_.first += stride_;
    return true;
  }

 private:
  Held array_;
  Raster next_;
  py::ssize_t stride_;  // from one picture to the next
};

class IteratorClip final : public PicturesClip {
 public:
  IteratorClip(Held pictures, const PictureNotes& notes, const ClipOptions& options, std::string name)
      : PicturesClip(notes, options, std::move(name)), pictures_(std::move(pictures)) {}

  bool read(std::span<std::byte> raster) override {
    const py::gil_scoped_acquire locked;
    PyObject* const next = PyIter_Next(pictures_->ptr());
    if (next == nullptr) {
      if (PyErr_Occurred() != nullptr) throw py::error_already_set();
      return false;
    }
    const auto picture = py::array::ensure(py::reinterpret_steal<py::object>(next));
    check(picture);
    take(raster_of(picture, 0), raster);
    return true;
  }

 private:
  void check(const py::array& picture) const {
    if (!picture) throw py::error_already_set();
    const Shape& shape = notes_.shape;
    const auto is = [&](py::ssize_t axis, std::uint32_t size) {
      return picture.shape(axis) == static_cast<py::ssize_t>(size);
    };
    const bool fits =
        (picture.ndim() == 2 && shape.channels == 1 && is(0, shape.height) && is(1, shape.width)) ||
        (picture.ndim() == 3 && is(0, shape.height) && is(1, shape.width) && is(2, shape.channels));
    if (fits && is_of_native(picture)) return;
    throw InputError(format(
        "{}: picture {} has shape {} and dtype {}, the first one {} x {} pixels, {} channel{} "
        "of {} bits; all must be alike",
        name_, taken_, std::string(py::str(picture.attr("shape"))), std::string(py::str(picture.dtype())),
        shape.width, shape.height, shape.channels, shape.channels == 1 ? "" : "s", 8 * notes_.code_bytes));
  }
  [[nodiscard]] bool is_of_native(const py::array& picture) const {
    return notes_.code_bytes == 1 ? py::isinstance<py::array_t<std::uint8_t>>(picture)
                                  : py::isinstance<py::array_t<std::uint16_t>>(picture);
  }

  Held pictures_;
};

}  // namespace

OpenClip open_array(const py::array& pictures, PictureNotes notes, ClipOptions options, std::string name) {
  const Raster first = raster_of(pictures, 1);
  return [array = held(pictures), first, stride = pictures.strides(0), notes = std::move(notes),
          options = std::move(options), name = std::move(name)]() -> std::unique_ptr<Clip> {
    return std::make_unique<ArrayClip>(array, first, stride, notes, options, name);
  };
}

OpenClip open_iterator(const py::iterator& pictures, PictureNotes notes, ClipOptions options,
                       std::string name) {
  return [iterator = held(pictures), is_open = std::make_shared<std::atomic_flag>(), notes = std::move(notes),
          options = std::move(options), name = std::move(name)]() -> std::unique_ptr<Clip> {
    if (is_open->test_and_set()) {
      throw UsageError(
          format("{} can be read once, and what is asked for reads it twice; pass an array", name));
    }
    return std::make_unique<IteratorClip>(iterator, notes, options, name);
  };
}

}  // namespace nutik::python
