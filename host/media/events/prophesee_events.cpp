// Words are little-endian; bits are counted from the lowest:
//
//   EVT 2.0, 32 bits    28 type:   0 down, 1 up   0 y (11), 11 x (11), 22 time (6)
//                                  8 time         0 the time above its lowest 6 bits (28)
//   EVT 2.1, 64 bits    as EVT 2.0 in one half; in the other 32 pixels, from x to the right, of which bits tell those
//                       that have the event
//   EVT 3.0, 16 bits    12 type:   0 y (11; bit 11: another camera)
//                                  2 x (11), 11 up: an event
//                                  3 x (11), 11 up: where vectors begin
//                                  4, 5 vector of 12 or 8 pixels, which moves that on
//                                  6 time, its lowest 12 bits; 8 time, the 12 bits above them
//   DAT, 64 bits        0 time (32), 32 x (14), 46 y (14), 60 up (4)
//
// Other types (triggers, counters of the sensor) are left out. What comes before the first time has none.
#include "media/events/prophesee_events.hpp"

#include <algorithm>
#include <array>
#include <bit>
#include <limits>
#include <optional>

#include "capture/format.hpp"
#include "media/events/event_light.hpp"

namespace nutik {
namespace {

using Bytes = std::span<const std::byte>;

constexpr std::int64_t kMicrosecondNs = 1000;

std::uint32_t bits(std::uint64_t word, unsigned first, unsigned count) {
  return static_cast<std::uint32_t>(word >> first & ((std::uint64_t{1} << count) - 1));
}

std::uint64_t word_at(Bytes bytes, std::size_t at, std::size_t size) {
  std::uint64_t word = 0;
  for (std::size_t i = size; i-- > 0;) word = word << 8 | std::to_integer<std::uint64_t>(bytes[at + i]);
  return word;
}

// A clock of so many bits, which begins again when they are used up.
class CameraClock {
 public:
  CameraClock(unsigned clock_bits, const std::string& name) : period_(std::int64_t{1} << clock_bits), name_(name) {}

  [[nodiscard]] bool is_set() const { return is_set_; }
  [[nodiscard]] std::int64_t time_us() const { return time_; }
  // Further back than half of the period: it began again. Back by less: the file is out of order.
  void set(std::uint64_t clock) {
    std::int64_t now = static_cast<std::int64_t>(clock) + loops_;
    if (is_set_ && now < time_ - period_ / 2) {
      loops_ += period_;
      now += period_;
      constexpr std::int64_t kLongestUs = (std::int64_t{1} << 62) / 1000;  // as nanoseconds, too, it has 62 bits
      if (loops_ > kLongestUs) {
        throw InputError(format(
            "{}'s clock begins again so often that it lasts longer than 146 years: its times are damaged", name_));
      }
    } else if (loops_ > 0 && now > time_ + period_ / 2) {
      now -= period_;  // a straggler from before it began again
    }
    is_set_ = true;
    time_ = now;
  }

 private:
  std::int64_t period_;
  const std::string& name_;
  std::int64_t loops_ = 0;
  std::int64_t time_ = 0;
  bool is_set_ = false;
};

// What a file holds, without holding it.
struct EventTally {
  std::uint64_t events = 0;
  std::uint64_t moments = 0;  // events later than all before them: at least as many samples
  std::uint32_t right_of_all = 0, below_all = 0;
};
using KnownCount = std::optional<std::uint64_t>;  // of events

class Decoder {
 public:
  // `size` is that of a word. What does not fill one at the end is left over. Events are kept where it is known how
  // many there are; else they are counted.
  Decoder(Bytes words, std::size_t size, KnownCount known)
      : words_(words), size_(size), is_keeping_(known.has_value()) {
    events.reserve(known.value_or(0));
  }

  template <typename Each>
  void for_each_word(Each each) {
    std::size_t at = 0;
    for (; at + size_ <= words_.size(); at += size_) each(word_at(words_, at, size_));
    left_over = words_.size() - at;
  }
  void add(std::int64_t time_us, std::uint32_t x, std::uint32_t y, bool is_up) {
    if (is_keeping_) {
      events.push_back({time_us, static_cast<std::uint16_t>(x), static_cast<std::uint16_t>(y), is_up});
      return;
    }
    if (tally.events == 0 || time_us > latest_us_) ++tally.moments;
    ++tally.events;
    latest_us_ = std::max(latest_us_, time_us);
    tally.right_of_all = std::max(tally.right_of_all, x + 1);
    tally.below_all = std::max(tally.below_all, y + 1);
  }

  EventTally tally;
  std::vector<CameraEvent> events;
  std::size_t left_over = 0;  // bytes
  std::uint64_t untimed = 0;  // events before the first time

 private:
  Bytes words_;
  std::size_t size_;
  bool is_keeping_;
  std::int64_t latest_us_ = std::numeric_limits<std::int64_t>::min();
};

enum Type32 : std::uint32_t { kDown = 0, kUp = 1, kTime = 8 };

// A word of EVT 2.0, or the half of one of EVT 2.1 that has no pixels; of `pixels` those beside x that are set.
void add_evt2(Decoder& decoder, CameraClock& high, std::uint32_t word, std::uint32_t pixels) {
  const std::uint32_t type = bits(word, 28, 4);
  if (type == kTime) high.set(std::uint64_t{bits(word, 0, 28)} << 6);
  if (type != kDown && type != kUp) return;
  if (!high.is_set()) {
    decoder.untimed += static_cast<std::uint64_t>(std::popcount(pixels));
    return;
  }
  for (; pixels != 0; pixels &= pixels - 1) {
    const auto beside = static_cast<std::uint32_t>(std::countr_zero(pixels));
    decoder.add(high.time_us() + bits(word, 22, 6), bits(word, 11, 11) + beside, bits(word, 0, 11),
                type == kUp);
  }
}

constexpr unsigned kEvt2ClockBits = 34;

Decoder decode_evt2(Bytes words, KnownCount known, const std::string& name) {
  Decoder decoder(words, 4, known);
  CameraClock high(kEvt2ClockBits, name);
  decoder.for_each_word([&](std::uint64_t word) { add_evt2(decoder, high, static_cast<std::uint32_t>(word), 1); });
  return decoder;
}

// Which half has the type: the upper one, but for sensors whose files say `legacy`. If nobody says, the half whose
// types are all known.
bool has_type_above(Bytes words, const std::string& endianness) {
  if (!endianness.empty()) return endianness != "legacy";
  constexpr std::size_t kEnough = 4096;
  std::array<std::size_t, 2> unknown{};  // of the lower half, of the upper one
  for (std::size_t at = 0; at + 8 <= std::min(words.size(), kEnough); at += 8) {
    for (std::size_t half = 0; half < 2; ++half) {
      const std::uint32_t type = bits(word_at(words, at + 4 * half, 4), 28, 4);
      const bool is_known = type == kDown || type == kUp || type == kTime || type == 10 || type >= 14;
      if (!is_known) ++unknown[half];
    }
  }
  return unknown[1] <= unknown[0];
}

Decoder decode_evt21(Bytes words, bool type_is_above, KnownCount known, const std::string& name) {
  Decoder decoder(words, 8, known);
  CameraClock high(kEvt2ClockBits, name);
  decoder.for_each_word([&](std::uint64_t word) {
    const std::uint32_t lower = bits(word, 0, 32), upper = bits(word, 32, 32);
    add_evt2(decoder, high, type_is_above ? upper : lower, type_is_above ? lower : upper);
  });
  return decoder;
}

Decoder decode_evt3(Bytes words, KnownCount known, const std::string& name) {
  enum Type : std::uint32_t { kY = 0, kX = 2, kBaseX = 3, kVector12 = 4, kVector8 = 5, kLow = 6, kHigh = 8 };
  Decoder decoder(words, 2, known);
  CameraClock clock(24, name);
  std::uint32_t y = 0, base_x = 0, high = 0;
  bool is_this_camera = true, is_up = false;
  const auto add = [&](std::uint32_t x, bool up) {
    if (!clock.is_set()) {
      ++decoder.untimed;
    } else if (is_this_camera) {
      decoder.add(clock.time_us(), std::min(x, 0xFFFFu), y, up);  // vectors may go on and on to the right
    }
  };
  decoder.for_each_word([&](std::uint64_t word) {
    const std::uint32_t value = bits(word, 0, 12), coordinate = bits(word, 0, 11);
    const bool flag = bits(word, 11, 1) != 0;
    switch (const std::uint32_t type = bits(word, 12, 4)) {
      case kY:
        y = coordinate;
        is_this_camera = !flag;
        break;
      case kX: add(coordinate, flag); break;
      case kBaseX:
        base_x = coordinate;
        is_up = flag;
        break;
      case kVector12:
      case kVector8: {
        const std::uint32_t length = type == kVector12 ? 12 : 8;
        for (std::uint32_t i = 0; i < length; ++i) {
          if (bits(word, i, 1) != 0) add(base_x + i, is_up);
        }
        base_x += length;
        break;
      }
      case kHigh:
        // The lowest bits follow in a word of their own; until then they are 0, but where the high ones repeat.
        if (!clock.is_set() || value != high) clock.set(std::uint64_t{value} << 12);
        high = value;
        break;
      case kLow:
        if (clock.is_set()) clock.set(std::uint64_t{high} << 12 | value);
        break;
      default: break;
    }
  });
  return decoder;
}

Decoder decode_dat(Bytes words, KnownCount known, const std::string& name) {
  Decoder decoder(words, 8, known);
  CameraClock clock(32, name);
  decoder.for_each_word([&](std::uint64_t word) {
    clock.set(bits(word, 0, 32));
    decoder.add(clock.time_us(), bits(word, 32, 14), bits(word, 46, 14), bits(word, 60, 4) != 0);
  });
  return decoder;
}

Bytes dat_words(Bytes file, const PropheseeHeader& header, const std::string& name) {
  constexpr unsigned kEvent2d = 0, kEventCd = 12, kEventBytes = 8;
  const Bytes rest = file.subspan(header.bytes);
  if (rest.size() < 2) throw InputError(format("{} ends within its header", name));
  const auto type = std::to_integer<unsigned>(rest[0]), size = std::to_integer<unsigned>(rest[1]);
  if ((type != kEvent2d && type != kEventCd) || size != kEventBytes || header.of("version") == "1") {
    throw InputError(
        format("{} holds events of the type {}, of {} bytes{}; of .dat files those of contrast (type 0 or 12, 8 "
               "bytes, version 2) are read, and of .raw files those whose header names their format (% evt 2.0)",
               name, type, size, header.of("version") == "1" ? " and version 1" : ""));
  }
  return rest.subspan(2);
}

// Sensors' sizes, by what the names of their plugins hold.
struct Sensor {
  const char* name;
  std::uint32_t width, height;
};
constexpr Sensor kSensors[] = {{"genx320", 320, 320},  {"gen3", 640, 480},    {"gen4", 1280, 720},
                               {"imx636", 1280, 720}, {"imx646", 1280, 720}};

void set_size(CameraEvents& recording, const PropheseeHeader& header, const EventTally& tally) {
  recording.width = header.pixels("width");
  recording.height = header.pixels("height");
  recording.size_from = "the file";
  if (recording.width > 0 && recording.height > 0) return;
  const std::string& plugin = header.of("plugin_name");
  for (const Sensor& sensor : kSensors) {
    if (plugin.find(sensor.name) == plugin.npos) continue;
    recording.width = sensor.width;
    recording.height = sensor.height;
    recording.size_from = "plugin_name " + plugin;
    return;
  }
  recording.size_from.clear();
  recording.width = tally.right_of_all;
  recording.height = tally.below_all;
  recording.notes.emplace_back(format(
      "the file does not say how many pixels the sensor has; its events lie within {} x {}, which are taken",
      recording.width, recording.height));
}

// Events outside the sensor are left out: a few are faults of it, many a header that is mistaken.
void leave_out_others(CameraEvents& recording, const std::string& name) {
  const std::size_t all = recording.events.size();
  const CameraEvent* first = nullptr;
  const auto is_outside = [&](const CameraEvent& event) {
    return event.x >= recording.width || event.y >= recording.height;
  };
  const auto found = std::ranges::find_if(recording.events, is_outside);
  if (found == recording.events.end()) return;
  first = &*found;
  const std::string where = format("{},{}", first->x, first->y);
  const std::size_t outside = std::erase_if(recording.events, is_outside);
  const std::string text =
      format("{} of {} events lie outside the sensor's {} x {} pixels ({}), the first at {}", outside, all,
             recording.width, recording.height, recording.size_from, where);
  if (outside > all / 10) throw InputError(format("{}: {}; correct the size in its header", name, text));
  recording.notes.emplace_back(text + ": they are left out");
}

void put_in_order(CameraEvents& recording) {
  const auto is_before = [](const CameraEvent& a, const CameraEvent& b) { return a.time_us < b.time_us; };
  std::size_t back = 0;
  std::int64_t furthest = 0;
  std::int64_t latest = recording.events.front().time_us;
  for (const CameraEvent& event : recording.events) {
    if (event.time_us < latest) ++back;
    furthest = std::max(furthest, latest - event.time_us);
    latest = std::max(latest, event.time_us);
  }
  if (back == 0) return;
  std::ranges::stable_sort(recording.events, is_before);
  recording.notes.emplace_back(
      format("{} events come after later ones, by up to {} us: they are put in order", back, furthest));
}

Decoder decode(Bytes file, const PropheseeHeader& header, const std::string& name, std::string& kind,
               KnownCount known) {
  const Bytes words = file.subspan(header.bytes);
  const std::string& format_name = header.of("format");
  const std::string& evt = header.of("evt");
  if (format_name == "EVT2" || (format_name.empty() && evt == "2.0")) {
    kind = "EVT 2.0";
    return decode_evt2(words, known, name);
  }
  if (format_name == "EVT21" || (format_name.empty() && evt == "2.1")) {
    kind = "EVT 2.1";
    return decode_evt21(words, has_type_above(words, header.of("endianness")), known, name);
  }
  if (format_name == "EVT3" || (format_name.empty() && evt == "3.0")) {
    kind = "EVT 3.0";
    return decode_evt3(words, known, name);
  }
  if (!format_name.empty() || !evt.empty()) {
    throw InputError(nutik::format(
        "{} is in the format {}; EVT 2.0, 2.1 and 3.0 are read. Convert it to DAT: metavision_file_to_dat -i {}",
        name, format_name.empty() ? "EVT " + evt : format_name, name));
  }
  kind = "DAT";
  return decode_dat(dat_words(file, header, name), known, name);
}

}  // namespace

CameraEvents read_prophesee_events(Bytes file, const std::string& name, const ClipOptions& options) {
  const PropheseeHeader header = read_prophesee_header(file);
  CameraEvents recording;
  const EventTally tally = decode(file, header, name, recording.kind, std::nullopt).tally;
  if (tally.events == 0) {
    throw InputError(format("{} holds no event ({}, {} bytes after its header)", name, recording.kind,
                            file.size() - header.bytes));
  }
  set_size(recording, header, tally);
  const Shape shape{recording.width, recording.height, 1};
  check_picture_size(shape, tally.events, name);
  // Ticks of more than a microsecond may make one sample of several moments: that is counted when they are in order.
  const bool counts_moments = options.events.tick_ns.value_or(kMicrosecondNs) <= kMicrosecondNs;
  check_event_memory({sizeof(CameraEvent), tally.events, counts_moments ? tally.moments : 1}, shape, options);
  Decoder decoder = decode(file, header, name, recording.kind, tally.events);
  recording.events = std::move(decoder.events);
  if (decoder.left_over > 0) {
    recording.notes.push_back(warning_of(
        format("{} was cut off within an event: its last {} bytes are left out", name, decoder.left_over)));
  }
  if (decoder.untimed > 0) {
    recording.notes.emplace_back(format(
        "{} events come before the first time in the file: they are left out", decoder.untimed));
  }
  leave_out_others(recording, name);
  put_in_order(recording);
  return recording;
}

}  // namespace nutik
