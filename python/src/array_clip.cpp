// Clips that lie in memory or are made picture by picture: NumPy arrays, and iterators of them.
#include <atomic>
#include <cstring>
#include <functional>
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

class PicturesClip final : public Clip {
 public:
  using Next = std::function<std::optional<Raster>()>;  // none: there is no other

  PicturesClip(const PictureNotes& notes, const ClipOptions& options, std::string name, Next next)
      : notes_(notes), info_(info_of(notes, options)), name_(std::move(name)), next_(std::move(next)) {}

  [[nodiscard]] const ClipInfo& info() const override { return info_; }

  bool read(std::span<std::byte> raster) override {
    const std::optional<Raster> picture = next_();
    if (!picture) return false;
    copy_raster(*picture, notes_, raster);
    const std::uint32_t white = info_.format.white_code, last = notes_.code_bytes == 1 ? 255 : 65'535;
    const std::uint32_t code = white < last ? largest_code(raster, notes_.code_bytes) : 0;
    if (code > white)
      throw InputError(format("{}: picture {} has the code {}, above white, {}", name_, taken_, code, white),
                       {Setting::white_code});
    ++taken_;
    return true;
  }

 private:
  PictureNotes notes_;
  ClipInfo info_;
  std::string name_;
  Next next_;
  std::uint64_t taken_ = 0;
};

}  // namespace

OpenClip open_array(const py::array& pictures, PictureNotes notes, ClipOptions options, std::string name) {
  return [array = held(pictures), first = raster_of(pictures, 1), stride = pictures.strides(0),
          notes = std::move(notes), options = std::move(options), name = std::move(name)] {
    return std::make_unique<PicturesClip>(
        notes, options, name, [array, next = first, stride, left = notes.sample_count]() mutable {
          const std::optional<Raster> picture = left > 0 ? std::optional(next) : std::nullopt;
          next.first += left > 0 ? stride : 0;
          left -= left > 0 ? 1 : 0;
          return picture;
        });
  };
}

OpenClip open_iterator(const py::iterator& pictures, PictureNotes notes, ClipOptions options, std::string name) {
  return [iterator = held(pictures), is_open = std::make_shared<std::atomic_flag>(), notes = std::move(notes),
          options = std::move(options), name = std::move(name)] {
    if (is_open->test_and_set())
      throw UsageError(
          format("{} can be read once, and what is asked for reads it twice; pass an array", name));
    return std::make_unique<PicturesClip>(
        notes, options, name, [iterator, picture = Held()]() mutable -> std::optional<Raster> {
          const py::gil_scoped_acquire locked;
          picture.reset();  // before the next one is made
          PyObject* const next = PyIter_Next(iterator->ptr());
          if (next == nullptr && PyErr_Occurred() != nullptr) throw py::error_already_set();
          if (next == nullptr) return std::nullopt;
          picture = held(py::reinterpret_steal<py::object>(next));
          return raster_of(py::reinterpret_borrow<py::array>(*picture), 0);
        });
  };
}

}  // namespace nutik::python
