#include "media/videos/capture_rate.hpp"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <initializer_list>
#include <span>
#include <string_view>

#include "capture/error.hpp"
#include "capture/median.hpp"
#include "capture/text.hpp"
#include "media/cameras/sony_file.hpp"
#include "system/mapped_file.hpp"

namespace nutik::videos {
namespace {

using namespace std::string_view_literals;

// Rates that lie this close are the same, as cameras keep time.
constexpr double kSameRate = 0.02;

constexpr std::string_view kAnyCodec = "????";

// What the first box holds that lies within boxes of these types; empty where there is none. A box is u32 size with its
// header of 8 bytes, then four letters; a size of 1 stands for a u64 behind them, 0 for all that is left. `stsd` has
// fields before its boxes, and so has each track's description in it, whose type is its codec.
std::string_view box_at(std::string_view boxes, std::span<const std::string_view> path) {
  constexpr std::size_t kHeader = 8, kLongHeader = 16;
  while (boxes.size() >= kHeader) {
    std::uint64_t size = big_endian(boxes, 0, 4);
    std::size_t header = kHeader;
    if (size == 1 && boxes.size() >= kLongHeader) {
      size = big_endian(boxes, kHeader, 8);
      header = kLongHeader;
    }
    if (size == 0) size = boxes.size();
    if (size < header || size > boxes.size()) return {};
    const bool is_codec = path.front() == kAnyCodec;
    if (is_codec || boxes.substr(4, 4) == path.front()) {
      const std::uint64_t begin = header + (is_codec ? 78u : path.front() == "stsd" ? 8u : 0u);
      const std::string_view held = begin < size ? boxes.substr(begin, size - begin) : std::string_view();
      const std::string_view found = path.size() == 1 ? held : box_at(held, path.subspan(1));
      if (!found.empty()) return found;
    }
    boxes.remove_prefix(size);
  }
  return {};
}

std::string_view box_at(std::string_view boxes, std::initializer_list<std::string_view> path) {
  return box_at(boxes, std::span(path.begin(), path.size()));
}

// What smta says: u32 version and flags, then boxes. saut: four letters, then pairs of a key and a value of one byte
// each; key 0 is the recording mode. srfr: the rate as 16.16 bits. As Android's player reads them, too.
struct SamsungRecording {
  bool is_slow = false;  // super slow motion, too, of which nothing tells the rate
  std::optional<Rational> rate;
};

SamsungRecording samsung_recording(std::string_view file) {
  constexpr std::size_t kVersionBytes = 4, kAuthorBytes = 4;
  std::string_view smta = box_at(file, {"moov", "udta", "smta"});
  if (smta.size() < kVersionBytes) return {};
  smta.remove_prefix(kVersionBytes);
  const std::string_view author = box_at(smta, {"saut"});
  for (std::size_t at = kAuthorBytes; at + 2 <= author.size(); at += 2) {
    if (author[at] != 0) continue;
    switch (author[at + 1]) {
      case 7:
      case 9:
      case 22:
      case 23: return {true, std::nullopt};
      case 12: return {true, Rational{240, 1}};
      case 13: return {true, Rational{120, 1}};
      case 21: {
        const std::string_view rate = box_at(smta, {"srfr"});
        if (rate.size() < 4 || big_endian(rate, 0, 2) == 0) return {true, std::nullopt};
        return {true, Rational::of(static_cast<std::int64_t>(big_endian(rate, 0, 4)), 1 << 16)};
      }
      default: return {};
    }
  }
  return {};
}

// The text of Sony's NonRealTimeMeta; empty where there is none. Where another file has it, `other` becomes that.
std::string sony_story(const std::filesystem::path& path, std::filesystem::path& other) {
  constexpr std::string_view kName = "<NonRealTimeMeta";
  constexpr std::uintmax_t kMaxBytes = 1u << 20;
  const MappedFile mapped(path);
  for (const auto& boxes : {std::vector<std::string_view>{"meta"}, {"moov", "meta"}}) {
    const std::string_view text = box_at(as_text(mapped.bytes()), boxes);
    if (const auto at = text.find(kName); at != text.npos) return std::string(text.substr(at));
  }
  const std::filesystem::path beside = sony_file_of(path);
  std::error_code error;
  const std::uintmax_t bytes = std::filesystem::file_size(beside, error);
  if (error || bytes == 0 || bytes > kMaxBytes) return {};
  try {
    const MappedFile story(beside);
    std::string text(as_text(story.bytes()));
    if (text.find(kName) == text.npos) return {};
    other = beside;
    return text;
  } catch (const InputError&) {
    return {};  // the clip can be read without it
  }
}

// What stands between quotes behind `before`, from `from` on.
std::string quoted(const std::string& text, std::string_view before, std::size_t from = 0) {
  const std::size_t at = from == text.npos ? text.npos : text.find(before, from);
  if (at == text.npos) return {};
  const std::size_t begin = at + before.size(), end = text.find('"', begin);
  return end == text.npos ? std::string() : text.substr(begin, end - begin);
}

// <Item name="CaptureGammaEquation" value="s-log3-cine"/>
std::string item_of(const std::string& story, std::string_view name) {
  return quoted(story, "value=\"", story.find(format("name=\"{}\"", name)));
}

// `119.88p`, which is 120000/1001; `50i` counts fields, as the file does not.
std::optional<Rational> sony_rate(const std::string& story) {
  constexpr double kRounded = 0.006;
  const std::string text = quoted(story, "captureFps=\"");
  double rate = 0.0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), rate);
  if (error != std::errc() || std::string_view(end) != "p" || !(rate > 0.0 && rate < 1e6)) return std::nullopt;
  for (const std::int64_t divisor : {1000, 1001}) {
    const double whole = std::round(rate * static_cast<double>(divisor) / 1000);
    if (whole > 0 && std::fabs(whole * 1000 / static_cast<double>(divisor) - rate) < kRounded)
      return Rational::of(static_cast<std::int64_t>(whole) * 1000, divisor);
  }
  return std::nullopt;
}

// In the words of Sony's XML: `s-log3-cine`, `s-gamut3-cine`. Empty where it is not said.
struct CameraUnit {
  std::string curve, gamut;
  std::optional<Rational> rate;  // pictures a second
  std::string from = "the file";  // what says it
};

// An item of MXF (SMPTE ST 336): a key of 16 bytes, the length of the value in one byte or in as many as 0x80 + n says,
// the value. Takes the first from `items`; empty at their end, and where the value is cut off.
struct MxfItem {
  std::string_view key, value;
};

MxfItem take_item(std::string_view& items) {
  constexpr std::size_t kKey = 16;
  if (items.size() <= kKey) return {};
  const auto first = static_cast<unsigned char>(items[kKey]);
  const std::size_t more = first < 0x80 ? 0 : first - 0x80, begin = kKey + 1 + more;
  const std::uint64_t length = more == 0 ? first : big_endian(items, kKey + 1, more);
  if (more > 8 || items.size() < begin || items.size() - begin < length) return {};
  const MxfItem item{items.substr(0, kKey), items.substr(begin, length)};
  items.remove_prefix(begin + length);
  return item;
}

// The value that a set has under a tag: u16 tag, u16 length, value, one behind the other.
std::string_view tagged(std::string_view set, std::uint64_t tag) {
  while (set.size() >= 4) {
    const std::uint64_t length = big_endian(set, 2, 2);
    if (set.size() - 4 < length) break;
    if (big_endian(set, 0, 2) == tag) return set.substr(4, length);
    set.remove_prefix(4 + length);
  }
  return {};
}

// Sony's labels of curves and primaries, which SMPTE registered for it.
std::string sonys_name(std::string_view label) {
  constexpr std::string_view kSonys = "\x06\x0E\x2B\x34\x04\x01\x01\x06\x0E\x06\x04\x01"sv;
  if (!label.starts_with(kSonys)) return {};
  switch (big_endian(label, kSonys.size(), 4)) {
    case 0x01010508: return "s-log2";
    case 0x01010604: return "s-log3";
    case 0x01010605: return "s-log3-cine";
    case 0x01030103: return "s-gamut";
    case 0x01030104: return "s-gamut3";
    case 0x01030105: return "s-gamut3-cine";
    default: return {};
  }
}

// The camera unit's set in ancillary data (SMPTE RDD 18 in ST 436): u16 packets, each of a header of 6 bytes, u32
// bytes, u32 1, then 0x43 0x05, u8 length, u8 number of the message and a part of the items.
std::string unit_items(std::string_view ancillary) {
  constexpr std::size_t kHeader = 14;
  std::string items;
  std::uint64_t packets = big_endian(ancillary, 0, 2);
  ancillary.remove_prefix(std::min<std::size_t>(2, ancillary.size()));
  for (; packets > 0 && ancillary.size() > kHeader; --packets) {
    const std::string_view packet = ancillary.substr(kHeader, big_endian(ancillary, 6, 4));
    if (packet.starts_with("\x43\x05"sv) && packet.size() > 4)
      items += packet.substr(4, std::max<std::uint64_t>(big_endian(packet, 2, 1), 1) - 1);
    ancillary.remove_prefix(kHeader + packet.size());
  }
  return items;
}

// An MXF's labels that describe the pictures, and those of the first ancillary data beside them (SMPTE RDD 18), which
// stay where the description was written anew. All is empty in a file of another kind. The rate of interlaced files is
// not read, for they may count fields.
CameraUnit mxf_unit(std::string_view file) {
  constexpr std::string_view kFile = "\x06\x0E\x2B\x34\x02\x05\x01\x01\x0D\x01\x02"sv,
                             kDescriptions = "\x06\x0E\x2B\x34\x02\x53\x01\x01\x0D"sv,
                             kUnits = "\x06\x0E\x2B\x34\x02\x53\x01\x01\x0C"sv,
                             kEssence = "\x06\x0E\x2B\x34\x01\x02\x01"sv, kAncillary = "\x0D\x01\x03\x01\x17"sv;
  constexpr std::uint64_t kCurve = 0x3210, kGamut = 0x3219, kLayout = 0x320C, kRate = 0x8106;
  constexpr int kMaxItems = 4096;  // those of the first picture lie before
  CameraUnit unit;
  if (!file.starts_with(kFile)) return unit;
  bool is_whole = false;
  const auto read = [&](std::string_view set) {
    if (const std::string name = sonys_name(tagged(set, kCurve)); !name.empty()) unit.curve = name;
    if (const std::string name = sonys_name(tagged(set, kGamut)); !name.empty()) unit.gamut = name;
  };
  for (int k = 0; k < kMaxItems; ++k) {
    const MxfItem item = take_item(file);
    if (item.key.empty()) break;
    if (item.key.starts_with(kDescriptions)) {
      is_whole = is_whole || tagged(item.value, kLayout) == "\0"sv;
      read(item.value);
    }
    if (!item.key.starts_with(kEssence) || item.key.substr(8, 5) != kAncillary) continue;
    const std::string items = unit_items(item.value);
    std::string_view left = items;
    for (MxfItem set = take_item(left); !set.key.empty(); set = take_item(left)) {
      if (!set.key.starts_with(kUnits)) continue;
      read(set.value);
      const std::string_view rate = tagged(set.value, kRate);
      const auto parts = [&](std::size_t at) { return static_cast<std::int64_t>(big_endian(rate, at, 4)); };
      if (is_whole && parts(0) > 0 && parts(4) > 0) unit.rate = Rational::of(parts(0), parts(4));
    }
    break;
  }
  return unit;
}

// What Sony's camera says: its XML, else the file's own metadata.
CameraUnit camera_unit(const std::filesystem::path& path) {
  std::filesystem::path beside;
  const std::string story = sony_story(path, beside);
  if (story.empty()) return mxf_unit(as_text(MappedFile(path).bytes()));
  return {item_of(story, "CaptureGammaEquation"), item_of(story, "CaptureColorPrimaries"), sony_rate(story),
          beside.empty() ? CameraUnit().from : beside.filename().string()};
}

bool is_mp4(std::string_view file) { return file.size() >= 8 && file.substr(4, 4) == "ftyp"; }

double mean_rate(const std::vector<std::int64_t>& starts_ns) {
  return static_cast<double>(starts_ns.size() - 1) * static_cast<double>(kSecondNs) /
         static_cast<double>(starts_ns.back() - starts_ns.front());
}

// How many pictures a second times show where none is missing between them: pictures that were dropped leave gaps of
// whole periods. 0 where times keep no such period.
double steady_rate(const std::vector<std::int64_t>& starts_ns) {
  constexpr int kMaxParts = 6;         // of the usual difference, which is no period where most were dropped
  constexpr double kBetter = 0.5;       // than a longer period, which fits as well by chance
  constexpr double kMaxMisfit = 0.1;   // periods, in the mean; times that keep none are 0.25 off
  constexpr double kFewMisfits = 0.03;  // single pictures that came late are no sign of a shorter period
  if (starts_ns.size() < 2) return 0.0;
  std::vector<double> differences;
  for (std::size_t k = 1; k < starts_ns.size(); ++k)
    differences.push_back(static_cast<double>(starts_ns[k] - starts_ns[k - 1]));
  const double median_ns = median(differences);
  const double span_ns = static_cast<double>(starts_ns.back() - starts_ns.front());
  if (!(median_ns > 0.0 && span_ns > 0.0)) return 0.0;
  double best_ns = 0.0, least = kMaxMisfit / kBetter;
  for (int parts = 1; parts <= kMaxParts && least > kFewMisfits; ++parts) {
    double period_ns = median_ns / parts, misfit = 0.0;
    // Once more with the mean period, for the usual difference was rounded to the container's clock.
    for (int pass = 0; pass < 2; ++pass) {
      double periods = 0.0;
      misfit = 0.0;
      for (const double difference : differences) {
        const double whole = std::max(1.0, std::round(difference / period_ns));
        misfit += std::fabs(difference / period_ns - whole) / static_cast<double>(differences.size());
        periods += whole;
      }
      period_ns = span_ns / periods;
    }
    if (misfit >= kBetter * least) continue;
    best_ns = period_ns;
    least = misfit;
  }
  return best_ns > 0.0 ? static_cast<double>(kSecondNs) / best_ns : 0.0;
}

}  // namespace

std::filesystem::path story_beside(const std::filesystem::path& path) {
  std::filesystem::path beside;
  static_cast<void>(sony_story(path, beside));
  return beside;
}

std::optional<NamedCurve> named_curve(const AVFormatContext& format, const std::filesystem::path& path,
                                      std::vector<Note>& notes) {
  const auto said = [&](const char* key) {
    const AVDictionaryEntry* entry = av_dict_get(format.metadata, key, nullptr, 0);
    return std::string_view(entry == nullptr ? "" : entry->value);
  };
  if (said("com.dji.camera.ColorGammaSxS") == "D-Log") return NamedCurve{Transfer::log("dlog"), std::nullopt};
  if (said("com.arri.camera.ColorGammaSxS") == "LOG-C") {
    // The curve is another one at each exposure index.
    const std::string_view index = said("com.arri.camera.ExposureIndexAsa");
    if (index == "800") return NamedCurve{Transfer::log("logc3"), std::nullopt};
    notes.emplace_back(
        nutik::format("the file's curve is LOG-C at exposure index {:.20}, and only that of 800 is known "
                      "here: the curve that the container names is taken",
                      index.empty() ? "unknown" : index),
        std::vector{Setting::transfer});
  }
  // As Apple's VideoToolbox names them, kCVImageBufferLogTransferFunction_AppleLog and _AppleLog2.
  const MappedFile mapped(path);
  const std::string_view in_track =
      box_at(as_text(mapped.bytes()), {"moov", "trak", "mdia", "minf", "stbl", "stsd", kAnyCodec, "logs"});
  const auto is_apples = [&](std::string_view name) {
    return in_track == name || said("com.apple.proapps.customgamma") == name;
  };
  if (is_apples("com.apple.rec2020.apple-log")) return NamedCurve{Transfer::log("applelog"), Primaries::bt2020};
  if (is_apples("com.apple.apple-wide-gamut.apple-log"))
    return NamedCurve{Transfer::log("applelog"), Primaries::apple_wide_gamut};
  const auto [curve, gamut, rate, from] = camera_unit(path);
  const char* const known = curve == "s-log2" ? "slog2" : curve.starts_with("s-log3") ? "slog3" : nullptr;
  if (known == nullptr) return std::nullopt;
  NamedCurve named{Transfer::log(known), std::nullopt, from};
  if (gamut == "s-gamut" || gamut == "s-gamut3") named.primaries = Primaries::sgamut3;
  if (gamut == "s-gamut3-cine") named.primaries = Primaries::sgamut3_cine;
  return named;
}

std::optional<CaptureRate> capture_rate(const AVFormatContext& format, const std::filesystem::path& path,
                                        std::vector<Note>& notes) {
  constexpr const char* kAndroid = "com.android.capture.fps";
  if (const AVDictionaryEntry* entry = av_dict_get(format.metadata, kAndroid, nullptr, 0)) {
    std::optional<Rational> rate;
    try {
      rate = Rational::parse(entry->value, kAndroid);
    } catch (const UsageError&) {  // no number: said below
    }
    if (rate && rate->numerator > 0) return CaptureRate{*rate, kAndroid};
    notes.emplace_back(nutik::format("the file's {} is '{:.40}', which is no rate: how fast it was filmed is "
                                     "not known, and the rate at which it plays is taken",
                                     kAndroid, entry->value),
                       std::vector{Setting::frame_rate});
  }
  if (const CameraUnit unit = camera_unit(path); unit.rate)
    return CaptureRate{*unit.rate, "Sony's captureFps", unit.from};
  const MappedFile mapped(path);
  if (!is_mp4(as_text(mapped.bytes()))) return std::nullopt;
  const SamsungRecording samsung = samsung_recording(as_text(mapped.bytes()));
  if (samsung.rate) return CaptureRate{*samsung.rate, "Samsung's smta"};
  if (samsung.is_slow) {
    notes.emplace_back(
        "Samsung's camera calls the recording slow motion and does not say how fast it was filmed: the rate "
        "at "
        "which it plays is taken; state the rate of filming",
        std::vector{Setting::frame_rate});
  }
  return std::nullopt;
}

bool has_edits(const std::filesystem::path& path) {
  const MappedFile mapped(path);
  std::string_view boxes = box_at(as_text(mapped.bytes()), {"moov"});
  while (!boxes.empty()) {
    const std::string_view track = box_at(boxes, {"trak"});
    if (track.empty()) return false;
    boxes.remove_prefix(static_cast<std::size_t>(track.data() + track.size() - boxes.data()));
    // hdlr: u32 version and flags, u32 0, then what the track holds.
    const std::string_view handler = box_at(track, {"mdia", "hdlr"});
    if (handler.size() < 12 || handler.substr(8, 4) != "vide") continue;
    // elst: u8 version, three bytes of flags, u32 count, then for each part its length and its start (-1: nothing is
    // shown), of 4 bytes, or of 8 in version 1, and its speed as 16.16 bits.
    const std::string_view list = box_at(track, {"edts", "elst"});
    if (list.size() < 8) continue;
    const std::size_t number = list[0] == 1 ? 8 : 4, part_bytes = 2 * number + 4;
    int parts = 0;
    for (std::size_t at = 8; at + part_bytes <= list.size(); at += part_bytes) {
      const std::uint64_t start = big_endian(list, at + number, number);
      if (start == (number == 8 ? UINT64_MAX : UINT32_MAX)) continue;
      if (++parts > 1 || big_endian(list, at + 2 * number, 4) != 1u << 16) return true;
    }
  }
  return false;
}

bool has_slow_parts(const std::filesystem::path& path) {
  // The trailer ends with its length and four letters.
  constexpr std::string_view kEnd = "SEFT", kName = "SlowMotion_Data";
  constexpr std::size_t kTail = 8, kMaxBytes = 1u << 20;
  const MappedFile mapped(path);
  const std::string_view file = as_text(mapped.bytes());
  return is_mp4(file) && file.ends_with(kEnd) &&
         file.substr(file.size() - std::min(file.size(), kMaxBytes + kTail)).find(kName) != file.npos;
}

void apply_capture_rate(const CaptureRate& filmed, ClipTiming& timing, std::vector<Note>& notes) {
  if (!timing.rate && timing.starts_ns.size() < 2) return;
  const bool is_within = filmed.from == CameraUnit().from;
  const double played = timing.rate ? timing.rate->value() : steady_rate(timing.starts_ns);
  const std::string played_text = timing.rate ? format("{:.6g}", played) : format("{:.3g}", played);
  const double times = played > 0.0 ? filmed.rate.value() / played : 0.0;
  // Where times tremble, their mean tells more than a period that fits them all.
  constexpr double kTremble = 0.05;
  const bool is_mean =
      !timing.rate && std::fabs(filmed.rate.value() / mean_rate(timing.starts_ns) - 1.0) < kTremble;
  if (std::fabs(times - 1.0) < kSameRate || is_mean) {
    timing.rate_from = is_within ? format("the file, as {} says", filmed.name) : filmed.from;
    return;
  }
  const double whole = times >= 1.0 ? times : 1.0 / times;
  const double nearest = std::round(whole);
  if (!(std::fabs(whole / nearest - 1.0) <= kSameRate)) {
    const std::string plays = played > 0.0
                                  ? format("plays {}, no whole number of times slower or faster", played_text)
                                  : std::string("plays them at uneven times, of no rate that can be told");
    notes.emplace_back(format("{} says that {} pictures a second were filmed, and the file {}: its own times "
                              "are taken; state the rate that is right",
                              filmed.name, filmed.rate.text(), plays),
                       std::vector{Setting::frame_rate});
    return;
  }
  notes.emplace_back(
      format("{} says that {} pictures a second were filmed, which the file plays as {}: times are those of "
             "filming; state another rate if that is wrong",
             filmed.name, filmed.rate.text(), played_text),
      std::vector{Setting::frame_rate});
  timing.rate_from = is_within ? format("the file's {}", filmed.name) : filmed.from;
  if (timing.rate) {
    timing.rate = filmed.rate;
    return;
  }
  const auto factor = static_cast<std::int64_t>(nearest);
  for (std::int64_t& start_ns : timing.starts_ns) {
    // What is longer than a capture lasts is refused where the timeline is made of it.
    const int128 slower = std::min<int128>(static_cast<int128>(start_ns) * factor, INT64_MAX);
    start_ns = times > 1.0 ? round_half_up(start_ns, factor) : static_cast<std::int64_t>(slower);
  }
}

}  // namespace nutik::videos
