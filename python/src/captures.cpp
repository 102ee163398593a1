// Captures: opened, encoded from clips and from arrays, and what is known of them.
#include <pybind11/stl.h>

#include <deque>
#include <mutex>

#include "align/alignment.hpp"
#include "array_clip.hpp"
#include "capture/error.hpp"
#include "capture/format.hpp"
#include "capture/memory_needs.hpp"
#include "errors.hpp"
#include "features/captures/capture_figures.hpp"
#include "features/captures/joining.hpp"
#include "features/schema/option.hpp"
#include "features/schema/requests.hpp"
#include "imev/each_block.hpp"
#include "imev/sample_cursor.hpp"
#include "parts.hpp"
#include "session/clips/encoding.hpp"
#include "working.hpp"

namespace nutik::python {
namespace {

// All captures of a process share devices, which start once. They are never ended: an OpenCL driver's threads may
// outlive the interpreter.
std::shared_ptr<Devices> devices_of(const Settings& computing) {
  const ComputingRequest request = computing_request(stated_options(CommandId::expose, computing));
  static std::mutex finding;
  static auto& known = *new std::deque<std::shared_ptr<Devices>>();
  const std::lock_guard lock(finding);
  for (const auto& devices : known) {
    if (devices->request() == request) return devices;
  }
  known.push_back(std::make_shared<Devices>(request));
  return known.back();
}

// How a clip is read, and by what; `open` makes one that its owner has.
struct Opening {
  SourceRequest source;
  std::shared_ptr<Devices> devices;
  OpenClip open;
};

Opening opening_of(const std::string& path, const Settings& settings, const Settings& computing) {
  return {clip_request(stated_options(CommandId::encode, settings), path), devices_of(computing), {}};
}

std::shared_ptr<OpenCapture> opened(const Opening& terms, const py::object& progress) {
  return without_lock([&](const Stopping& stopping) {
    Session::Terms how;
    how.progress = stopping.progress();
    how.stop = stopping.stop;
    how.open_clip = terms.open;
    auto session = std::make_unique<Session>(terms.source, terms.devices, how);
    return std::make_shared<OpenCapture>(OpenCapture{terms.source.path.string(), std::move(session)});
  }, progress);
}

// A capture, what is doubtful about it, and what a person should know of the clip.
py::tuple told_of(std::shared_ptr<OpenCapture> capture, std::vector<std::string> warnings,
                  const std::vector<Note>& notes) {
  return py::make_tuple(std::move(capture), std::move(warnings), note_texts(notes, Dialect::python));
}

py::tuple opened_and_told(const Opening& terms, const py::object& progress) {
  std::shared_ptr<OpenCapture> capture = opened(terms, progress);
  const Session& session = *capture->session;
  return told_of(capture, session.warnings(), session.notes());
}

// To a file, or to a temporary capture.
py::tuple encoded(const Opening& terms, const std::optional<std::string>& output, const std::string& codec,
                  const py::object& progress) {
  const tik::Codec packed = tik::Codec::parse(codec);
  if (output && !is_tik(*output))
    throw UsageError(format("{} is no name for a capture, which ends in .tik", *output));
  if (!output) return opened_and_told(terms, progress);
  const EncodeRequest request{*output, packed};
  EncodedCapture made = without_lock([&](const Stopping& stopping) {
    const MemoryBudget& memory = terms.devices->request().memory;
    return terms.open ? encode(terms.source, terms.open, request, memory, stopping.progress(), stopping.stop)
                      : encode(terms.source, request, memory, stopping.progress(), stopping.stop);
  }, progress);
  Opening of_file;
  of_file.source.path = *output;
  of_file.devices = terms.devices;
  return told_of(opened(of_file, py::none()), std::move(made.warnings), made.notes);
}

py::tuple open(const std::string& path, const Settings& settings, const Settings& computing,
               const py::object& progress) {
  return opened_and_told(opening_of(path, settings, computing), progress);
}

py::tuple encode_clip(const std::string& path, const std::optional<std::string>& output,
                      const std::string& codec, const Settings& settings, const Settings& computing,
                      const py::object& progress) {
  if (is_tik(path)) throw UsageError(format("{} is a capture already; nutik.open() opens it", path));
  return encoded(opening_of(path, settings, computing), output,
                 codec, progress);
}

py::tuple joined(const std::vector<std::string>& captures, const std::string& output,
                 const Settings& computing, const py::object& progress) {
  const JoinRequest request{{captures.begin(), captures.end()}, output};
  const Joined made =
      without_lock([&](const Stopping& stopping) { return join(request, stopping.progress()); }, progress);
  Opening of_file;
  of_file.source.path = output;
  of_file.devices = devices_of(computing);
  return told_of(opened(of_file, py::none()), {}, made.notes);
}

// `first` is a picture: of an iterator its first one, which it will return again. Times are those of ClipTiming.
py::tuple encode_pictures(const py::object& pictures, const py::array& first, const std::string& name,
                          const std::vector<std::int64_t>& starts_ns,
                          const std::vector<std::pair<std::int64_t, std::int64_t>>& exposures_ns,
                          std::optional<std::int64_t> exposed_ns, std::optional<double> white_light,
                          const std::optional<std::string>& output, const std::string& codec, const Settings& settings,
                          const Settings& computing, const py::object& progress) {
  PictureNotes notes;
  notes.shape = {static_cast<std::uint32_t>(first.shape(1)), static_cast<std::uint32_t>(first.shape(0)),
                 first.ndim() == 3 ? static_cast<std::uint32_t>(first.shape(2)) : 1U};
  notes.code_bytes = static_cast<std::uint32_t>(first.itemsize());
  notes.timing.rate_from = "what the caller said";
  notes.timing.starts_ns = starts_ns;
  for (const auto& [start_ns, end_ns] : exposures_ns) notes.timing.exposures.push_back({start_ns, end_ns});
  notes.timing.exposed_ns = exposed_ns;
  notes.white_light = white_light;
  Opening terms = opening_of(name, settings, computing);
  if (py::isinstance<py::array>(pictures)) {
    const auto array = pictures.cast<py::array>();
    notes.sample_count = static_cast<std::uint64_t>(array.shape(0));
    terms.open = open_array(array, std::move(notes), terms.source.clip, name);
  } else {
    notes.sample_count = std::max(starts_ns.size(), exposures_ns.size());
    terms.open = open_iterator(py::iter(pictures), std::move(notes), terms.source.clip, name);
  }
  return encoded(terms, output, codec, progress);
}

py::array times_ns(const OpenCapture& capture) {
  const Timeline& timeline = capture.session->timeline();
  const std::uint64_t count = timeline.sample_count();
  std::vector<std::int64_t> times;
  times.reserve(2 * count);
  for (std::uint64_t k = 0; k < count; ++k) {
    times.push_back(timeline.start_ns(k));
    times.push_back(timeline.end_ns(k));
  }
  return array_of(times, {static_cast<py::ssize_t>(count), 2});
}

std::vector<std::string> facts(const OpenCapture& capture) {
  return capture.session->capture().header().facts;
}

py::dict figures(const OpenCapture& capture) {
  Session& session = *capture.session;
  tik::Reader& reader = session.capture();
  const CaptureFormat& format = session.format();
  const Timeline& timeline = session.timeline();
  const CaptureFigures held = without_lock([&](const Stopping&) { return nutik::figures_of(reader); });
  const auto& [still, rows, dense, records] = held.tiles;
  py::dict tiles;
  tiles["still"] = still;
  tiles["rows"] = rows;
  tiles["dense"] = dense;
  tiles["records"] = records;
  py::dict told;
  told["samples"] = timeline.sample_count();
  told["duration_ns"] = timeline.duration_ns();
  const auto pair = [](const Rational& number) { return py::make_tuple(number.numerator, number.denominator); };
  told["rate"] = pair(timeline.rate());
  told["is_constant_rate"] = timeline.is_constant();
  told["shutter_angle"] = pair(timeline.shutter_angle());
  told["white"] = format.white_code;
  told["transfer"] = format.transfer.text();
  told["primaries"] = std::string(to_text(format.primaries));
  told["pixel_aspect"] = pair(format.pixel_aspect);
  told["tolerance"] = format.noise.tolerance;
  told["blocks"] = reader.block_count();
  told["records"] = held.record_count;
  told["tiles"] = tiles;
  told["file_bytes"] = reader.file_bytes();
  told["raw_bytes"] = held.raw_bytes;
  told["memory_bytes"] = held.payload_bytes;
  told["codec"] = reader.header().codec;
  return told;
}

// The codes that are held at samples. It keeps the block of the one before: samples in a row unpack each block once.
class SampleReader {
 public:
  explicit SampleReader(std::shared_ptr<OpenCapture> capture)
      : capture_(std::move(capture)), blocks_(capture_->session->capture()) {}

  void read(std::uint64_t sample, std::span<std::byte> raster) {
    if (!block_ || sample < first_ || sample >= block_->extent().range().last) find_block(sample);
    samples_->go_to(static_cast<std::uint32_t>(sample - block_->extent().first_sample));
    samples_->read(raster);
    first_ = sample;
  }

  [[nodiscard]] const CaptureFormat& format() const { return capture_->session->format(); }
  // [axes..., height, width(, 3)]
  [[nodiscard]] py::array rasters(std::vector<py::ssize_t> axes) const {
    const std::vector<py::ssize_t> sides = axes_of(format().shape);
    axes.insert(axes.end(), sides.begin(), sides.end());
    return {format().code_bytes == 1 ? py::dtype::of<std::uint8_t>() : py::dtype::of<std::uint16_t>(), axes};
  }

 private:
  void find_block(std::uint64_t sample) {
    tik::Reader& reader = capture_->session->capture();
    std::uint64_t block = 0;
    while (reader.block_extent(block).range().last <= sample) ++block;
    samples_.reset();
    block_.reset();
    block_.emplace(blocks_.at(block));
    samples_.emplace(format().shape, *block_);
  }

  std::shared_ptr<OpenCapture> capture_;
  BlockCursor blocks_;
  std::optional<BlockView> block_;
  std::optional<SampleCursor> samples_;
  std::uint64_t first_ = 0;  // a cursor only goes on
};

// At samples in increasing order, [samples, height, width(, 3)].
py::array samples(std::shared_ptr<OpenCapture> capture, const std::vector<std::uint64_t>& numbers) {
  SampleReader reader(std::move(capture));
  py::array rasters = reader.rasters({static_cast<py::ssize_t>(numbers.size())});
  auto* bytes = static_cast<std::byte*>(rasters.mutable_data());
  without_lock([&](const Stopping& stopping) {
    for (const std::uint64_t number : numbers) {
      if (stopping.stop.stop_requested()) throw Cancelled();
      reader.read(number, {bytes, reader.format().sample_bytes()});
      bytes += reader.format().sample_bytes();
    }
  });
  return rasters;
}

py::array sample(SampleReader& reader, std::uint64_t number) {
  py::array raster = reader.rasters({});
  auto* const bytes = static_cast<std::byte*>(raster.mutable_data());
  const Unlocked released;
  reader.read(number, {bytes, reader.format().sample_bytes()});
  return raster;
}

// What pixels of a box hold between two samples, from one change to the next: of each record the pixel's place, the
// samples at which it begins and ends, and its codes; of each pixel in time order.
py::tuple records(const OpenCapture& capture, const std::vector<std::uint32_t>& box, std::uint64_t first,
                  std::uint64_t last, const py::object& progress) {
  Session& session = *capture.session;
  const Shape& shape = session.format().shape;
  const Rectangle region{box[0], box[1], box[2], box[3]};
  struct Record {
    std::uint64_t begin = 0, end = 0;
    std::array<std::uint16_t, 3> codes{};
  };
  std::vector<std::vector<Record>> found(std::size_t{region.width} * region.height);
  constexpr std::uint64_t kMostBytes = std::uint64_t{4} << 30;
  constexpr std::uint64_t kBytes = 3 * sizeof(Record) + 40;  // of a record: growing, copied, and in the array
  std::vector<std::uint32_t> places;
  std::vector<std::uint64_t> times;
  std::vector<std::uint16_t> codes;
  without_lock([&](const Stopping& stopping) {
    const ReportedProgress report = stopping.progress();
    std::vector<ChangeRecord> history;
    std::uint64_t count = 0;
    for_each_block(session.capture(), {first, last}, [&](const BlockView& block) {
      const SampleRange range = block.extent().range();
      const std::uint64_t from = std::max(first, range.first);
      const TileGrid grid(shape);
      auto pixel = found.begin();
      for (std::uint32_t y = region.y; y < region.y + region.height; ++y) {
        report(from - first + (y - region.y) * (std::min(last, range.last) - from) / region.height, last - first);
        for (std::uint32_t x = region.x; x < region.x + region.width; ++x, ++pixel) {
          block.read_history(grid.tile_of(x, y), TileGrid::lane_of(x, y), history);
          for (std::size_t i = 0; i < history.size(); ++i) {
            const std::uint64_t begin = std::max(first, range.first + history[i].sample);
            const std::uint64_t end =
                std::min(last, i + 1 < history.size() ? range.first + history[i + 1].sample : range.last);
            if (begin >= end) continue;
            if (!pixel->empty() && pixel->back().codes == history[i].codes) {
              pixel->back().end = end;  // a block begins anew with what is held
            } else {
              pixel->push_back({begin, end, history[i].codes});
              if (++count * kBytes > kMostBytes)
                throw MemoryTooLittle(kMostBytes, {{"records; ask for fewer pixels or samples", count * kBytes}});
            }
          }
        }
      }
    });
    for (std::size_t pixel = 0; pixel < found.size(); ++pixel) {
      for (const Record& record : found[pixel]) {
        places.push_back(region.x + static_cast<std::uint32_t>(pixel % region.width));
        places.push_back(region.y + static_cast<std::uint32_t>(pixel / region.width));
        times.insert(times.end(), {record.begin, record.end});
        codes.insert(codes.end(), record.codes.begin(), record.codes.begin() + shape.channels);
      }
      found[pixel] = {};
    }
  }, progress);
  const auto count = static_cast<py::ssize_t>(times.size() / 2);
  return py::make_tuple(array_of(places, {count, 2}), array_of(times, {count, 2}),
                        array_of(codes, {count, static_cast<py::ssize_t>(shape.channels)}));
}

std::optional<std::string> moved_camera_text(const OpenCapture& capture) {
  return without_lock([&](const Stopping&) -> std::optional<std::string> {
    const auto moved = moved_camera(capture.session->capture());
    return moved ? std::optional(moved->text()) : std::nullopt;
  });
}

}  // namespace

void bind_captures(py::module_& module) {
  py::class_<OpenCapture, std::shared_ptr<OpenCapture>>(module, "Capture")
      .def_property_readonly("name", [](const OpenCapture& capture) { return capture.name; })
      .def_property_readonly("shape",
                             [](const OpenCapture& capture) {
                               return py::tuple(py::cast(axes_of(capture.session->format().shape)));
                             })
      .def_property_readonly("code_bytes",
                             [](const OpenCapture& capture) { return capture.session->format().code_bytes; })
      .def_property_readonly(
          "sample_count",
          [](const OpenCapture& capture) { return capture.session->timeline().sample_count(); })
      .def_property_readonly(
          "duration_ns", [](const OpenCapture& capture) { return capture.session->timeline().duration_ns(); })
      .def_property_readonly("rate",
                             [](const OpenCapture& capture) {
                               const Rational rate = capture.session->timeline().rate();
                               return py::make_tuple(rate.numerator, rate.denominator);
                             })
      .def_property_readonly("facts", &facts)
      .def("times_ns", &times_ns)
      .def("figures", &figures)
      .def("samples", &samples, py::arg("numbers"))
      .def("reader",
           [](std::shared_ptr<OpenCapture> capture) { return std::make_unique<SampleReader>(std::move(capture)); })
      .def("records", &records, py::arg("box"), py::arg("first"), py::arg("last"),
           py::arg("progress"))
      .def("moved_camera", &moved_camera_text);
  py::class_<SampleReader>(module, "SampleReader").def("sample", &sample, py::arg("number"));
  module.def("open", &open, py::arg("path"), py::arg("settings"), py::arg("computing"), py::arg("progress"));
  module.def("encode_clip", &encode_clip, py::arg("path"), py::arg("output"), py::arg("codec"),
             py::arg("settings"), py::arg("computing"), py::arg("progress"));
  module.def("encode_pictures", &encode_pictures, py::arg("pictures"), py::arg("first"), py::arg("name"),
             py::arg("starts_ns"), py::arg("exposures_ns"), py::arg("exposed_ns"),
             py::arg("white_light"), py::arg("output"), py::arg("codec"), py::arg("settings"),
             py::arg("computing"), py::arg("progress"));
  module.def("join", &joined, py::arg("captures"), py::arg("output"), py::arg("computing"), py::arg("progress"));
}

}  // namespace nutik::python
