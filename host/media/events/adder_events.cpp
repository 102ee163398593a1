// Raw ADΔER files (.adder): each event tells how much light a pixel had since its event before.
//
//   0  adder · version u8 · b · width u16 · height u16 · ticks a second u32 · reference interval u32 · Δt_max u32
//      · bytes of an event u8 · channels u8 · [from version 1 on: source u32] · [2: time u32] · [3: interval u32]
//   then events: x u16 · y u16 · [of 3 channels: 1 u8, channel u8] · D u8 · t u32
//
// Big end first. 2^D is the light of the time since the pixel's last event, in units of which the source's white has so
// many in a reference interval; t is that time in ticks, or counts from the start (time 1). D 255 repeats the light
// before, 253 is no event, all others from 128 on are no light. x = y = 65535 ends the file.
#include "media/events/event_light.hpp"

#include <algorithm>
#include <cmath>
#include <optional>

#include "capture/format.hpp"
#include "capture/light_codes.hpp"
#include "capture/rational.hpp"
#include "media/settled_fact.hpp"

namespace nutik {
namespace {

using Bytes = std::span<const std::byte>;

// Where the light of an event came from; frames are numbers 0 … 5.
constexpr std::uint32_t kLastFramedSource = 5, kFramesOf16Bits = 1, kFramesOf32Bits = 2, kDavis = 7, kAtis = 8;
constexpr std::uint32_t kNewestVersion = 3;

struct AdderHeader {
  std::uint32_t version, width, height, ticks_a_second, interval, event_bytes, channels;
  std::uint32_t source = 0;  // frames of 8 bits
  bool counts_from_start = false;
  std::size_t bytes = 0;  // of the header

  [[nodiscard]] bool is_framed() const { return version >= 1 && source <= kLastFramedSource; }
};

// Reads numbers, the big end first, from a file that may end before.
class BigEndianReader {
 public:
  BigEndianReader(Bytes bytes, std::size_t at) : bytes_(bytes), at_(at) {}

  [[nodiscard]] std::size_t at() const { return at_; }
  [[nodiscard]] bool has(std::size_t count) const { return bytes_.size() - at_ >= count; }
  std::uint32_t take(std::size_t count) {
    std::uint32_t number = 0;
    for (std::size_t i = 0; i < count; ++i) number = number << 8 | std::to_integer<std::uint32_t>(bytes_[at_++]);
    return number;
  }

 private:
  Bytes bytes_;
  std::size_t at_;
};

AdderHeader read_header(Bytes file, const std::string& name) {
  constexpr std::size_t kMagicBytes = 5, kMinBytes = 25;
  if (file.size() < kMinBytes) throw InputError(format("{} ends within its header", name));
  BigEndianReader reader(file, kMagicBytes);
  AdderHeader header{};
  header.version = reader.take(1);
  const bool is_big = reader.take(1) == 'b';
  header.width = reader.take(2);
  header.height = reader.take(2);
  header.ticks_a_second = reader.take(4);
  header.interval = reader.take(4);
  reader.take(4);
  header.event_bytes = reader.take(1);
  header.channels = reader.take(1);
  const std::size_t more = 4 * std::min(header.version, kNewestVersion);
  if (!reader.has(more)) throw InputError(format("{} ends within its header", name));
  if (header.version >= 1) header.source = reader.take(4);
  if (header.version >= 2) {
    const std::uint32_t time = reader.take(4);
    if (time > 1) throw InputError(format("{} has times of the mode {}; 0 and 1 are read", name, time));
    header.counts_from_start = time == 1;
  }
  header.bytes = file.size() - file.subspan(kMinBytes + more).size();
  if (header.event_bytes == 10) header.event_bytes = 11;  // as old writers counted
  const bool has_size = header.width > 0 && header.height > 0 && (header.channels == 1 || header.channels == 3);
  if (!is_big || header.version > kNewestVersion || !has_size ||
      header.event_bytes != (header.channels == 1 ? 9u : 11u)) {
    throw InputError(
        format("{} has version {}, {} x {} pixels of {} channels and events of {} bytes; versions 0 to {} with 1 "
               "channel (9 bytes) or 3 (11 bytes) are read, big end first",
               name, header.version, header.width, header.height, header.channels, header.event_bytes,
               kNewestVersion));
  }
  if (header.ticks_a_second == 0 || header.interval == 0) {
    throw InputError(format("{} counts {} ticks a second and {} in a reference interval; neither can be 0", name,
                            header.ticks_a_second, header.interval));
  }
  return header;
}

// From a tick on a value of a picture is this light.
struct LightFrom {
  std::int64_t tick;
  std::uint32_t value;  // pixel · channels + channel
  std::uint16_t code;
};

// Follows every value's events.
class AdderEvents {
 public:
  AdderEvents(const std::string& name, const AdderHeader& header, const LightCodes& codes, double white)
      : name_(name),
        header_(header),
        codes_(codes),
        light_of_unit_(header.interval / white),
        ticks_(std::size_t{header.width} * header.height * header.channels),
        held_(ticks_.size()) {}

  void read(Bytes file);

  std::vector<LightFrom> found;
  std::int64_t end_tick = 0;
  std::uint64_t outside = 0, backward = 0, above_white = 0;
  std::size_t left_over = 0;
  bool has_end = false;

  // Size of `found`. Events go into it only after keep().
  std::uint64_t found_count = 0;
  void keep(std::uint64_t count) {
    found.reserve(count);
    is_keeping_ = true;
  }

  // Values that no event tells of.
  [[nodiscard]] std::uint64_t untold() const {
    return static_cast<std::uint64_t>(std::ranges::count(ticks_, 0));
  }

 private:
  void add(std::size_t value, std::uint32_t d, std::uint32_t time);

  const std::string& name_;
  bool is_keeping_ = false;
  AdderHeader header_;
  const LightCodes& codes_;
  double light_of_unit_;              // a unit in one tick
  std::vector<std::int64_t> ticks_;   // until which each value is known
  std::vector<std::uint16_t> held_;   // the code of each until then
};

void AdderEvents::read(Bytes file) {
  constexpr std::uint32_t kEnd = 0xFFFF;
  BigEndianReader reader(file, header_.bytes);
  while (reader.has(header_.event_bytes)) {
    const std::uint32_t x = reader.take(2), y = reader.take(2);
    if (x == kEnd && y == kEnd) {
      has_end = true;
      return;
    }
    std::uint32_t channel = 0;
    if (header_.channels > 1) {
      reader.take(1);
      channel = reader.take(1);
    }
    const std::uint32_t d = reader.take(1), time = reader.take(4);
    if (x >= header_.width || y >= header_.height || channel >= header_.channels) {
      ++outside;
    } else {
      add((std::size_t{y} * header_.width + x) * header_.channels + channel, d, time);
    }
  }
  left_over = file.size() - reader.at();
}

void AdderEvents::add(std::size_t value, std::uint32_t d, std::uint32_t time) {
  constexpr std::uint32_t kRepeats = 255, kNoEvent = 253, kMinOfNoLight = 128;
  if (d == kNoEvent) return;
  const std::int64_t from = ticks_[value];
  std::int64_t until = header_.counts_from_start ? std::int64_t{time} : from + time;
  if (until <= from) {
    // A second event at the same tick tells of no time.
    if (until < from) ++backward;
    return;
  }
  std::uint16_t code = held_[value];
  if (d != kRepeats) {
    const double light = d >= kMinOfNoLight ? 0.0
                                              : std::ldexp(light_of_unit_, static_cast<int>(d)) /
                                                    static_cast<double>(until - from);
    if (light > 1) ++above_white;
    code = static_cast<std::uint16_t>(codes_.code_of(std::min(light, 1.0)));
  }
  if (code != held_[value] || from == 0) {
    ++found_count;
    if (is_keeping_) found.push_back({from, static_cast<std::uint32_t>(value), code});
  }
  held_[value] = code;
  // In a framed recording an event ends before the next begins: what is left of the interval has none of its own.
  if (header_.is_framed()) until = (until + header_.interval - 1) / header_.interval * header_.interval;
  // So that times in nanoseconds have 62 bits.
  constexpr std::int64_t kLongest = std::int64_t{1} << 62;
  if (until > kLongest || until > static_cast<int128>(header_.ticks_a_second) * (kLongest / kSecondNs)) {
    throw InputError(
        format("{}: its events last longer than 146 years: its ticks a second or its times are damaged", name_));
  }
  end_tick = std::max(end_tick, until);
  ticks_[value] = until;
}

// What the source's codes call white, and so how many units it has in a reference interval.
std::uint32_t white_of(const AdderHeader& header, const ClipOptions& options, ClipInfo& info) {
  std::optional<std::uint32_t> named;
  if (header.version >= 1) {
    if (header.source == 0 || header.source == kDavis || header.source == kAtis) named = 255;
    if (header.source == kFramesOf16Bits) named = 65'535;
    if (header.source == kFramesOf32Bits) named = 0xFFFF'FFFF;
  }
  const std::uint32_t white =
      settle(info.facts, options.white_code, named, 255u, Setting::white_code,
             [](std::uint32_t code) { return format("white {} units in a reference interval", code); });
  if (info.facts.back().origin == Origin::file)
    info.facts.back().source = format("the file's source {}", header.source);
  return white;
}

}  // namespace

EventLight read_adder_file(Bytes file, const std::string& name, const ClipOptions& options, ClipInfo& info) {
  const AdderHeader header = read_header(file, name);
  if (options.events.contrast || options.events.start) {
    throw UsageError(format("{} tells light itself, and not by how much it changed", name),
                     {Setting::contrast, Setting::start_picture});
  }
  CaptureFormat& capture = info.format;
  capture.shape = {header.width, header.height, header.channels};
  check_picture_size(capture.shape, (file.size() - header.bytes) / header.event_bytes, name);
  capture.code_bytes = 2;
  capture.white_code = 65'535;
  describe_stored_codes(info, options, {Transfer::linear(), Transfer::linear(), {}, "how events are held"});
  info.facts.push_back({format("ADΔER, {} x {}, {} ticks a second", header.width, header.height,
                               header.ticks_a_second),
                        Origin::file, Setting::tick});
  info.roundings.add(0.5, 1.0, "events");
  const LightCodes codes(capture.transfer, capture.white_code);
  const std::uint32_t white = white_of(header, options, info);
  check_event_memory({sizeof(LightFrom), 0, 1}, capture.shape, options);  // of its pixels, before any is counted
  const std::uint64_t count = [&] {
    AdderEvents counted(name, header, codes, white);
    counted.read(file);
    return counted.found_count;
  }();
  if (count == 0) throw InputError(format("{} holds no event", name));
  check_event_memory({sizeof(LightFrom), count, 1}, capture.shape, options);
  AdderEvents events(name, header, codes, white);
  events.keep(count);
  events.read(file);

  const auto ns_of = [&](std::int64_t tick) {
    return round_half_up(static_cast<int128>(tick) * kSecondNs, header.ticks_a_second);
  };
  std::ranges::stable_sort(events.found, {}, &LightFrom::tick);
  EventLight result{std::vector<std::uint16_t>(capture.shape.value_count()),
                    ChangedSamples(options.events.tick_ns.value_or(1)), ns_of(events.end_tick)};
  const std::uint64_t samples =
      count_samples(result.samples, events.found, [&](const LightFrom& light) { return ns_of(light.tick); });
  check_event_memory({sizeof(LightFrom), count, samples}, capture.shape, options);
  result.samples.reserve(count, samples);
  std::vector<std::uint16_t> held(result.start);
  for (const LightFrom& light : events.found) {
    held[light.value] = light.code;
    PixelChange change{light.value / header.channels, {}};
    std::copy_n(held.begin() + change.pixel * header.channels, header.channels, change.codes.begin());
    result.samples.add(ns_of(light.tick), change);
  }

  const auto note = [&](std::uint64_t number, const char* text) {
    if (number > 0) info.notes.emplace_back(format("{} {}", number, text));
  };
  note(events.outside, "events lie outside the picture: they are left out");
  note(events.backward, "events end before the one before them at the same pixel: they are left out");
  note(events.untold(), "values have no event: they are black");
  if (events.above_white > 0) {
    info.notes.emplace_back(
        format("{} events are brighter than white, which holds them; state a higher white", events.above_white),
        std::vector{Setting::white_code});
  }
  if (events.left_over > 0) {
    info.notes.push_back(warning_of(
        format("{} bytes at the end are no whole event: the file was cut off", events.left_over)));
  } else if (!events.has_end) {
    info.notes.push_back(warning_of("the file has no end mark: what was filmed last may be missing"));
  }
  return result;
}

}  // namespace nutik
