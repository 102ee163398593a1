// Captures: opened, encoded from clips and from arrays, and what is known of them.
#include <atomic>
#include <cstddef>
#include <cstring>
#include <deque>
#include <memory>
#include <mutex>
#include <utility>

#include "capture/error.hpp"
#include "capture/format.hpp"
#include "capture/memory_needs.hpp"
#include "features/captures/capture_figures.hpp"
#include "features/captures/joining.hpp"
#include "features/schema/option.hpp"
#include "features/schema/requests.hpp"
#include "imev/each_block.hpp"
#include "imev/sample_cursor.hpp"
#include "media/settled_fact.hpp"
#include "parts.hpp"
#include "session/clips/encoding.hpp"
#include "system/is_absent.hpp"

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

// How a clip is read, and by what; `open` is of a clip that its owner makes, while the thread that asked waits.
struct Opening {
  SourceRequest source;
  std::shared_ptr<Devices> devices;
  std::function<OpenClip(const Stopping&)> open = [](const Stopping&) { return OpenClip(); };
};

Opening opening_of(const std::string& path, const Settings& settings, const Settings& computing) {
  return {clip_request(stated_options(CommandId::encode, settings), path), devices_of(computing)};
}

// A capture, what is doubtful about it, and what a person should know of the clip.
py::tuple opened(const Opening& terms, const py::object& progress) {
  const auto capture = without_lock([&](const Stopping& stopping) {
    Session::Terms how;
    how.progress = stopping.progress();
    how.stop = stopping.stop;
    how.open_clip = terms.open(stopping);
    auto session = std::make_unique<Session>(terms.source, terms.devices, how);
    return std::make_shared<OpenCapture>(OpenCapture{terms.source.path.string(), std::move(session)});
  }, progress);
  const Session& session = *capture->session;
  return py::make_tuple(capture, session.warnings(), note_texts(session.notes(), Dialect::python));
}

py::tuple open(const std::string& path, const Settings& settings, const Settings& computing,
               const py::object& progress) {
  if (!settings.empty() && is_tik(path) && !is_absent(path)) {
    const std::string& name = settings.begin()->first;
    const bool is_corrected = option_of_argument(CommandId::retime, name) != nullptr;
    throw UsageError(format("{}= describes a clip that is encoded; {} was encoded already. {}", name, path,
                            is_corrected ? "To correct it: nutik.retime(capture, new, " + name + "=...)"
                                         : "Encode the clip again with it"));
  }
  return opened(opening_of(path, is_tik(path) ? Settings() : settings, computing), progress);
}

// The capture that a file now holds.
py::object opened_file(const std::string& path, std::shared_ptr<Devices> devices) {
  Opening terms{{}, std::move(devices)};
  terms.source.path = path;
  return opened(terms, py::none())[0];
}

// To a file, or to a temporary capture.
py::tuple encoded(const Opening& terms, const std::optional<std::string>& output,
                  const std::optional<std::string>& codec, const py::object& progress) {
  const tik::Codec packed = codec ? tik::Codec::parse(*codec) : tik::kUsualCodec;
  if (codec && !output) throw UsageError("codec= is said of a file that is kept: name it, output='clip.tik'");
  if (output && !is_tik(*output)) throw UsageError(format("{} is no name for a capture, which ends in .tik", *output));
  if (!output) return opened(terms, progress);
  const EncodeRequest request{*output, packed};
  const EncodedCapture made = without_lock([&](const Stopping& stopping) {
    const MemoryBudget& memory = terms.devices->request().memory;
    return encode(terms.source, request, memory, stopping.progress(), stopping.stop, terms.open(stopping));
  }, progress);
  return py::make_tuple(opened_file(*output, terms.devices), made.warnings, note_texts(made.notes, Dialect::python));
}

py::tuple encode_clip(const std::string& path, const std::optional<std::string>& output,
                      const std::optional<std::string>& codec, const Settings& settings, const Settings& computing,
                      const py::object& progress) {
  if (is_tik(path)) throw UsageError(format("{} is a capture already; nutik.open() opens it", path));
  return encoded(opening_of(path, settings, computing), output, codec, progress);
}

py::tuple joined(const std::vector<std::string>& captures, const std::string& output, const Settings& computing,
                 const py::object& progress) {
  const JoinRequest request{{captures.begin(), captures.end()}, output};
  const auto one = without_lock([&](const Stopping& stopping) { return join(request, stopping.progress()); }, progress);
  return py::make_tuple(opened_file(output, devices_of(computing)), py::list(), note_texts(one.notes, Dialect::python));
}

// Python's objects, for threads that do not hold its lock.
template <typename Objects>
std::shared_ptr<Objects> held(Objects objects) {
  return {new Objects(std::move(objects)), [](Objects* last) {
            const py::gil_scoped_acquire locked;
            delete last;
          }};
}

class PicturesClip final : public Clip {
 public:
  PicturesClip(ClipInfo info, std::string name, py::object given, bool is_array, Stopping work)
      : info_(std::move(info)), name_(std::move(name)), iterator_(held(std::move(given))), is_array_(is_array),
        work_(std::move(work)) {}

  [[nodiscard]] const ClipInfo& info() const override { return info_; }

  bool read(std::span<std::byte> raster) override {
    if (!arrays_ || next_ == arrays_->size()) take();
    if (arrays_->empty()) return false;
    if (info_.sample_count != 0 && taken_ == info_.sample_count)
      throw InputError(format("{} has more pictures, but only {} times; give one of each", name_, taken_));
    std::memcpy(raster.data(), (*arrays_)[next_++].data(), raster.size());
    const std::uint32_t white = info_.format.white_code, last = info_.format.code_bytes == 1 ? 255 : 65'535;
    if (white != last || (last != 255 && largest_ <= kLeast))
      largest_ = std::max(largest_, largest_code(raster, info_.format.code_bytes));
    if (largest_ > white)
      throw InputError(format("{}: picture {} has the code {}, above white, {}", name_, taken_, largest_, white),
                       {Setting::white_code});
    ++taken_;
    return true;
  }

  [[nodiscard]] std::optional<std::string> ended_early() const override {
    if (taken_ >= info_.sample_count) return std::nullopt;
    return format("{} has {} pictures and {} times; those left over are of none", name_, taken_, info_.sample_count);
  }

  [[nodiscard]] std::vector<Note> remarks() const override {
    const Fact& last = info_.facts.back();  // of 16 bits what white is
    const bool is_assumed = last.setting == Setting::white_code && last.origin == Origin::assumed;
    if (!is_assumed || largest_ == 0 || largest_ > kLeast) return {};
    return {format("{}: no code is above {}, and white is taken to be 65535; state another, white=4095 for 12 bits",
                   name_, largest_)};
  }

 private:
  static constexpr std::uint32_t kLeast = 32'767;  // largest code that leaves no bit unused

  // One, or several views of a whole array, for Python's other threads may keep its lock for 5 ms each time.
  void take() {
    constexpr std::size_t kViews = 64;
    if (!is_array_) return work_.calls->make([&] { ask(1); }, work_.stop);
    const py::gil_scoped_acquire locked;
    ask(kViews);
  }

  // The next arrays without gaps, which are copies only where they have some: none at the end.
  void ask(std::size_t most) {
    arrays_ = held(std::vector<py::array>());
    for (next_ = 0; arrays_->size() < most;) {
      const auto given = py::reinterpret_steal<py::object>(PyIter_Next(iterator_->ptr()));
      if (!given && PyErr_Occurred() != nullptr) throw py::error_already_set();
      if (!given) return;
      arrays_->push_back(py::array::ensure(given, py::array::c_style));
      if (!arrays_->back()) throw std::bad_alloc();
      if (!arrays_->back().is(given)) return;
    }
  }

  ClipInfo info_;
  std::string name_;
  std::shared_ptr<py::object> iterator_;
  std::shared_ptr<std::vector<py::array>> arrays_;
  bool is_array_;
  Stopping work_;
  std::size_t next_ = 0;
  std::uint64_t taken_ = 0;
  std::uint32_t largest_ = 0;  // code so far, where it matters
};

// Pictures of uint8 or uint16, all of one shape: arrays that are read where they lie, of an iterable that the caller's
// thread asks. An iterator is opened once.
OpenClip open_pictures(const py::object& pictures, ClipInfo info, std::string name, const Stopping& work) {
  return [pictures = held(pictures), was_open = std::make_shared<std::atomic_flag>(), info = std::move(info),
          name = std::move(name), work] {
    const py::gil_scoped_acquire locked;
    py::object iterator = py::iter(*pictures);
    if (was_open->test_and_set() && iterator.is(*pictures))
      throw UsageError(format("{} can be read once, and what is asked for reads it twice; pass an array", name));
    return std::make_unique<PicturesClip>(info, name, std::move(iterator), py::isinstance<py::array>(*pictures), work);
  };
}

// All pictures have the shape of `first`; `count` is 0 where nobody knows it, times are those of ClipTiming.
py::tuple encode_pictures(const py::object& pictures, const py::array& first, std::uint64_t count,
                          const std::string& name, const std::vector<std::int64_t>& starts_ns,
                          const std::vector<std::pair<std::int64_t, std::int64_t>>& exposures_ns,
                          std::optional<std::int64_t> exposed_ns, std::optional<double> white_light,
                          const std::optional<std::string>& output, const std::optional<std::string>& codec,
                          const Settings& settings, const Settings& computing, const py::object& progress) {
  Opening terms = opening_of(name, settings, computing);
  ClipInfo info;
  info.format.shape = {static_cast<std::uint32_t>(first.shape(1)), static_cast<std::uint32_t>(first.shape(0)),
                       first.ndim() == 3 ? static_cast<std::uint32_t>(first.shape(2)) : 1U};
  info.format.code_bytes = static_cast<std::uint32_t>(first.itemsize());
  const bool is_short = info.format.code_bytes == 1;
  const std::optional<std::uint32_t>& white = terms.source.clip.white_code;
  info.timing.exposed_from = info.timing.rate_from = "what the caller said";
  info.timing.starts_ns = starts_ns;
  for (const auto& [start_ns, end_ns] : exposures_ns) info.timing.exposures.push_back({start_ns, end_ns});
  info.timing.exposed_ns = exposed_ns;
  info.sample_count = count;
  info.format.white_code = white.value_or(255);
  if (white_light) describe_light(info, *white_light);
  describe_stored_codes(info, terms.source.clip, {is_short ? Transfer::srgb() : Transfer::linear()});
  if (!is_short && !white_light) info.format.white_code = settle_white(info, white, {}, false);
  terms.open = [&](const Stopping& work) { return open_pictures(pictures, info, name, work); };
  return encoded(terms, output, codec, progress);
}

py::array times_ns(const OpenCapture& capture) {
  const Timeline& timeline = capture.timeline();
  std::vector<std::int64_t> times;
  for (std::uint64_t k = 0; k < timeline.sample_count(); ++k)
    times.insert(times.end(), {timeline.start_ns(k), timeline.end_ns(k)});
  return array_of(times, {static_cast<py::ssize_t>(timeline.sample_count()), 2});
}

// No Fraction: that would run Python's code within ours, where its end may stop it.
py::tuple fraction(const Rational& number) { return py::make_tuple(number.numerator, number.denominator); }

py::dict figures(const OpenCapture& capture) {
  tik::Reader& reader = capture.session->capture();
  const CaptureFormat& format = capture.session->format();
  const Timeline& timeline = capture.timeline();
  const CaptureFigures held = without_lock([&](const Stopping&) { return nutik::figures_of(reader); });
  const auto& [still, rows, dense, records] = held.tiles;
  return py::dict("samples"_a = timeline.sample_count(), "duration_ns"_a = timeline.duration_ns(),
      "rate"_a = fraction(timeline.rate()), "is_constant_rate"_a = timeline.is_constant(),
      "shutter_angle"_a = fraction(timeline.shutter_angle()), "white"_a = format.white_code,
      "transfer"_a = format.transfer.text(), "primaries"_a = to_text(format.primaries),
      "pixel_aspect"_a = fraction(format.pixel_aspect), "tolerance"_a = format.noise.tolerance,
      "blocks"_a = reader.block_count(), "records"_a = held.record_count,
      "tiles"_a = py::dict("still"_a = still, "rows"_a = rows, "dense"_a = dense, "records"_a = records),
      "file_bytes"_a = reader.file_bytes(), "raw_bytes"_a = held.raw_bytes, "memory_bytes"_a = held.payload_bytes,
      "codec"_a = text_of(reader.header().codec));
}

// The codes that are held at samples. It keeps the block of the one before: samples in a row unpack each block once.
class SampleReader {
 public:
  explicit SampleReader(std::shared_ptr<OpenCapture> capture)
      : capture_(std::move(capture)), blocks_(capture_->session->capture()) {}

  // [samples, height, width(, 3)], of increasing numbers. A single one is read without another thread.
  py::array samples(const std::vector<std::uint64_t>& numbers) {
    const CaptureFormat& format = capture_->session->format();
    py::array rasters(dtype_of(code_type(format)), axes_of(format.shape, {static_cast<py::ssize_t>(numbers.size())}));
    auto* to = static_cast<std::byte*>(rasters.mutable_data());
    const auto read = [&](const std::stop_token& stop) {
      for (const std::uint64_t number : numbers) {
        if (stop.stop_requested()) throw Cancelled();
        cursor_at(number).read({to, format.sample_bytes()});
        to += format.sample_bytes();
      }
    };
    if (numbers.size() > 1) {
      without_lock([&](const Stopping& stopping) { read(stopping.stop); });
    } else {
      const Unlocked released;
      read({});
    }
    return rasters;
  }

 private:
  SampleCursor& cursor_at(std::uint64_t sample) {
    if (!block_ || sample < first_ || sample >= block_->extent().range().last) {
      tik::Reader& reader = capture_->session->capture();
      std::uint64_t block = 0;
      while (reader.block_extent(block).range().last <= sample) ++block;
      samples_.reset();
      block_.reset();
      block_.emplace(blocks_.at(block));
      samples_.emplace(reader.format().shape, *block_);
    }
    first_ = sample;
    samples_->go_to(static_cast<std::uint32_t>(sample - block_->extent().first_sample));
    return *samples_;
  }

  std::shared_ptr<OpenCapture> capture_;
  BlockCursor blocks_;
  std::optional<BlockView> block_;
  std::optional<SampleCursor> samples_;
  std::uint64_t first_ = 0;  // a cursor only goes on
};

// Rows of `type`: x, y, start_ns, end_ns, codes, packed. The capture is looked through twice, first to count them:
// nothing but they and what each pixel was last is held.
py::array records(const OpenCapture& capture, const std::array<std::uint32_t, 4>& box, std::uint64_t first,
                  std::uint64_t last, const py::dtype& type, const py::object& progress) {
  struct Head {
    std::uint32_t x, y;
    std::int64_t start_ns, end_ns;
  };
  struct Pixel {
    std::uint64_t next = 0;  // row
    bool is_begun = false;
    std::array<std::uint16_t, 3> codes{};
  };
  tik::Reader& reader = capture.session->capture();
  const Timeline& timeline = capture.timeline();
  const TileGrid grid(capture.shape());
  const Rectangle region{box[0], box[1], box[2], box[3]};
  const auto row_bytes = static_cast<std::size_t>(type.itemsize());
  const std::size_t code_bytes = reader.format().code_bytes;
  std::vector<Pixel> pixels(std::size_t{region.width} * region.height);
  std::vector<ChangeRecord> history;
  py::array made;
  std::byte* rows = nullptr;  // while they are counted
  // What a pixel holds between two samples, of each pixel in time order; a block begins anew with what is held.
  const auto take = [&](std::size_t number, SampleRange held, const std::array<std::uint16_t, 3>& codes) {
    Pixel& pixel = pixels[number];
    const bool begins = !pixel.is_begun || pixel.codes != codes;
    pixel = {pixel.next + begins, true, codes};
    if (rows == nullptr) return;
    std::byte* const row = rows + (pixel.next - 1) * row_bytes;
    if (begins) {
      const Head head{region.x + static_cast<std::uint32_t>(number % region.width),
                      region.y + static_cast<std::uint32_t>(number / region.width), timeline.start_ns(held.first), 0};
      std::memcpy(row, &head, sizeof head);
      for (std::size_t c = 0; sizeof head + c * code_bytes < row_bytes; ++c)
        std::memcpy(row + sizeof head + c * code_bytes, &codes[c], code_bytes);
    }
    const std::int64_t end_ns = timeline.reach_end_ns(held.last - 1);
    std::memcpy(row + offsetof(Head, end_ns), &end_ns, sizeof end_ns);
  };
  without_lock([&](const Stopping& stopping) {
    const ReportedProgress report = stopping.progress();
    const auto look_through = [&](std::uint64_t before) {
      for_each_block(reader, {first, last}, [&](const BlockView& block) {
        const SampleRange range = block.extent().range();
        for (std::size_t number = 0; number < pixels.size(); ++number) {
          if (number % region.width == 0) report(before + std::max(first, range.first) - first, 2 * (last - first));
          const std::uint32_t x = region.x + static_cast<std::uint32_t>(number % region.width);
          const std::uint32_t y = region.y + static_cast<std::uint32_t>(number / region.width);
          block.read_history(grid.tile_of(x, y), TileGrid::lane_of(x, y), history);
          for (std::size_t i = 0; i < history.size(); ++i) {
            const std::uint64_t next = i + 1 < history.size() ? range.first + history[i + 1].sample : range.last;
            const SampleRange held{std::max(first, range.first + history[i].sample), std::min(last, next)};
            if (held.first < held.last) take(number, held, history[i].codes);
          }
        }
      });
    };
    look_through(0);
    std::uint64_t count = 0;
    for (Pixel& pixel : pixels) pixel = {std::exchange(count, count + pixel.next)};
    const std::string what = format("the records of {} pixels over {} samples", pixels.size(), last - first);
    MemoryNeeds({{what + " (take a part: region=, first= and last=)", count * row_bytes},
                 {"what pixels were last", pixels.size() * sizeof(Pixel)}})
        .rest_of(capture.session->devices().request().memory.bytes);
    {
      const py::gil_scoped_acquire locked;
      made = py::array(type, Axes{static_cast<py::ssize_t>(count)});
      rows = static_cast<std::byte*>(made.mutable_data());
    }
    look_through(last - first);
  }, progress);
  return made;
}

std::optional<std::string> moved_camera_text(const OpenCapture& capture) {
  return without_lock([&](const Stopping&) -> std::optional<std::string> {
    const auto moved = moved_camera(capture.session->capture());
    return moved ? std::optional(moved->text()) : std::nullopt;
  });
}

}  // namespace

void bind_captures(py::module_& module) {
  using Held = std::shared_ptr<OpenCapture>;
  py::class_<OpenCapture, Held>(module, "Capture")
      .def("__reduce__",
           [](const OpenCapture& capture) -> py::object {
             throw py::type_error(capture.name + ": a capture is an open file, which cannot be pickled; hand over its "
                                  "path, and open it there with nutik.open()");
           })
      .def_readonly("name", &OpenCapture::name)
      .def_property_readonly("shape", [](const OpenCapture& it) { return py::tuple(py::cast(axes_of(it.shape()))); })
      .def_property_readonly("code_bytes", [](const OpenCapture& held) { return held.session->format().code_bytes; })
      .def_property_readonly("sample_count", [](const OpenCapture& held) { return held.timeline().sample_count(); })
      .def_property_readonly("duration_ns", [](const OpenCapture& held) { return held.timeline().duration_ns(); })
      .def_property_readonly("rate", [](const OpenCapture& held) { return fraction(held.timeline().rate()); })
      .def_property_readonly("facts", [](const OpenCapture& held) {
        py::list facts;
        for (const std::string& fact : held.session->capture().header().facts) facts.append(text_of(fact));
        return facts;
      })
      .def("times_ns", &times_ns)
      .def("figures", &figures)
      .def("reader", [](Held held) { return std::make_unique<SampleReader>(std::move(held)); })
      .def("records", &records, "box"_a, "first"_a, "last"_a, "dtype"_a, "progress"_a)
      .def("moved_camera", &moved_camera_text);
  py::class_<SampleReader>(module, "SampleReader").def("samples", &SampleReader::samples, "numbers"_a);
  module.def("open", &open, "path"_a, "settings"_a, "computing"_a, "progress"_a);
  module.def("encode_clip", &encode_clip, "path"_a, "output"_a, "codec"_a, "settings"_a, "computing"_a, "progress"_a);
  module.def("encode_pictures", &encode_pictures, "pictures"_a, "first"_a, "count"_a, "name"_a, "starts_ns"_a,
             "exposures_ns"_a, "exposed_ns"_a, "white_light"_a, "output"_a, "codec"_a, "settings"_a, "computing"_a,
             "progress"_a);
  module.def(
      "code_thresholds",
      [](const std::string& transfer) { return Transfer::parse(transfer).code_thresholds(kLightSteps); }, "transfer"_a);
  module.def("join", &joined, "captures"_a, "output"_a, "computing"_a, "progress"_a);
}

}  // namespace nutik::python
