#include "media/videos/picture_times.hpp"

#include <algorithm>
#include <cstdio>
#include <string_view>

#include "capture/median.hpp"
#include "capture/text.hpp"
#include "media/videos/containers.hpp"

namespace nutik::videos {
namespace {

constexpr double kMostPictures = 10'000;  // a second, that are meant; a clock's ticks are more
constexpr std::int64_t kLongestSeconds = (std::int64_t{1} << 62) / kSecondNs;

// How far apart the pictures are that lie furthest before and behind where a constant rate puts them, all in units of
// 1 / (rate's numerator · time base's numerator) ticks, in which nothing is rounded.
struct Deviation {
  int128 spread, tick, period;
};

Deviation deviation(const std::vector<std::int64_t>& times, Rational time_base, Rational rate) {
  const int128 tick = static_cast<int128>(rate.numerator) * time_base.numerator;
  const int128 period = static_cast<int128>(rate.denominator) * time_base.denominator;
  int128 least = 0, most = 0;
  for (std::size_t i = 0; i < times.size(); ++i) {
    const int128 off = (static_cast<int128>(times[i]) - times[0]) * tick - static_cast<int128>(i) * period;
    least = std::min(least, off);
    most = std::max(most, off);
  }
  return {most - least, tick, period};
}

// Whether every time is where a constant rate puts it, but for the rounding to the container's clock. Where that clock
// has about a tick for a picture, as AVI's has, a slot that was left empty looks like rounding by the rate that the
// slots' number makes up: it counts only what lies within a share of the period. Times that were rounded once are less
// than a tick apart; those that cameras wrote were rounded twice.
bool fits(const std::vector<std::int64_t>& times, Rational time_base, const KnownRate& known) {
  const auto [spread, tick, period] = deviation(times, time_base, known.rate);
  const bool is_near = spread <= 2 * tick && 2 * spread < period;
  return is_near || (known.is_stated && spread < tick);
}

ClipTiming of_rate(Rational rate) {
  ClipTiming timing;
  timing.rate = rate;
  return timing;
}

// Whether the first line of a .y4m has a rate: F25:1; F0:0 is an unknown one.
bool y4m_states_rate(std::string_view file) {
  const std::string line(file.substr(0, file.find('\n')));
  const auto rate = line.find(" F");
  int pictures = 0, seconds = 0;
  return rate != line.npos && std::sscanf(line.c_str() + rate, " F%d:%d", &pictures, &seconds) == 2 &&
         pictures > 0 && seconds > 0;
}

// Whether an AVI states a rate: as scale and rate of its stream, else as microseconds a picture.
bool avi_states_rate(std::string_view file) {
  const auto four_at = [&](std::size_t at) { return file.substr(std::min(at, file.size()), 4); };
  const auto is_zero = [&](std::size_t at) { return std::string_view("\0\0\0\0", 4).starts_with(four_at(at)); };
  std::size_t stream = file.find("strh");
  while (stream != file.npos && four_at(stream + 8) != "vids") stream = file.find("strh", stream + 1);
  if (stream == file.npos || (!is_zero(stream + 28) && !is_zero(stream + 32))) return true;
  const std::size_t header = file.find("avih");
  return header != file.npos && !is_zero(header + 8);
}

// What a picture usually takes, in ticks: in GXF, packets of frames say that they last a field.
std::int64_t usual_step(const std::vector<PacketTimes>& packets) {
  std::vector<int128> steps;
  for (std::size_t i = 1; i < packets.size(); ++i)
    steps.push_back(static_cast<int128>(packets[i].decoded) - packets[i - 1].decoded);
  if (steps.empty()) return std::max<std::int64_t>(packets.back().duration, 1);
  return static_cast<std::int64_t>(std::clamp<int128>(median(std::move(steps)), 1, INT64_MAX));
}

bool is_timed(const std::vector<PacketTimes>& packets, std::int64_t PacketTimes::*time) {
  return std::ranges::none_of(packets,
                              [&](const PacketTimes& packet) { return packet.*time == AV_NOPTS_VALUE; });
}

}  // namespace

std::size_t packets_before_key(const std::vector<PacketTimes>& packets) {
  const auto key = std::ranges::find_if(packets, &PacketTimes::is_key);
  return key == packets.end() ? 0 : static_cast<std::size_t>(key - packets.begin());
}

bool must_be_decoded(const std::vector<PacketTimes>& packets) {
  if (packets.empty() || !is_timed(packets, &PacketTimes::shown)) {
    return std::ranges::any_of(packets,
                               [](const PacketTimes& packet) { return packet.shown != AV_NOPTS_VALUE; });
  }
  return std::ranges::min(packets, {}, &PacketTimes::shown).shown < packets.front().shown;
}

std::vector<std::int64_t> shown_times(const std::vector<PacketTimes>& packets, int delay) {
  std::vector<std::int64_t> times;
  if (is_timed(packets, &PacketTimes::shown)) {
    for (const PacketTimes& packet : packets) times.push_back(packet.shown);
    std::ranges::sort(times);  // packets come in the order of decoding
    return times;
  }
  // AVI may time the decoding alone. A decoder hands out a picture whenever it takes one in, once it holds as many as
  // are reordered; those that it holds at the end follow.
  if (packets.empty() || !is_timed(packets, &PacketTimes::decoded)) return {};
  const std::size_t held = std::min(packets.size(), static_cast<std::size_t>(std::max(delay, 0)));
  for (std::size_t i = held; i < packets.size(); ++i) times.push_back(packets[i].decoded);
  int128 time = packets.back().decoded;
  const std::int64_t step = usual_step(packets);
  for (std::size_t i = 1; i <= held; ++i)
    times.push_back(static_cast<std::int64_t>(std::min<int128>(time += step, INT64_MAX)));
  return times;
}

ClipTiming timing_of(const std::vector<std::int64_t>& times, Rational time_base, std::vector<KnownRate> rates,
                     const std::string& name) {
  const int128 span = (static_cast<int128>(times.back()) - times.front()) * time_base.numerator;
  if (span / time_base.denominator >= kLongestSeconds) {
    throw InputError(format("{}: its pictures' times are more than 146 years apart; state its rate", name),
                     {Setting::frame_rate});
  }
  // The rate that the first and last picture tell, for files that announce another or none. Three pictures would be
  // within a third of a period of it whatever the one in the middle is.
  const int128 turns = static_cast<int128>(times.size() - 1) * time_base.denominator;
  if (span > 0 && span <= INT64_MAX && turns <= INT64_MAX && times.size() > 3) {
    rates.push_back({Rational::of(static_cast<std::int64_t>(turns), static_cast<std::int64_t>(span))});
  }
  for (const KnownRate& known : rates) {
    if (fits(times, time_base, known)) return of_rate(known.rate);
  }
  ClipTiming timing;
  for (const std::int64_t time : times) {
    timing.starts_ns.push_back(round_half_up(
        (static_cast<int128>(time) - times[0]) * time_base.numerator * kSecondNs, time_base.denominator));
  }
  return timing;
}

std::optional<std::string> doubt_about_rate(const AVFormatContext& file, const AVStream& stream,
                                            std::span<const std::byte> bytes) {
  constexpr std::size_t kHeaderBytes = 1u << 16;
  const std::string_view kind = file.iformat->name;
  const std::string_view start = as_text(bytes).substr(0, kHeaderBytes);
  const AVRational rate = stream.r_frame_rate;
  const bool is_made_up =
      std::ranges::find(kUntimed, kind) != std::end(kUntimed) || av_cmp_q(rate, kUnstatedRate) == 0 ||
      (kind == "gif" && av_cmp_q(stream.avg_frame_rate, {100, kUnstatedDelay}) == 0) ||
      (kind == "yuv4mpegpipe" && !y4m_states_rate(start)) || (kind == "avi" && !avi_states_rate(start));
  if (is_made_up) return "";
  if (std::ranges::find(kStreams, kind) == std::end(kStreams) || av_q2d(rate) <= kMostPictures) return {};
  return format("its header states {:.10g} a second, which are a clock's ticks and no pictures",
                av_q2d(rate));
}

std::vector<KnownRate> announced_rates(const AVFormatContext& file, const AVStream& stream) {
  // QuickTime and MP4 state none: their mean is that of the pictures' times.
  const bool states_rate = !std::string_view(file.iformat->name).starts_with("mov");
  std::vector<KnownRate> rates;
  const auto add = [&](const AVRational& rate, bool is_stated) {
    if (rate.num > 0 && rate.den > 0) rates.push_back({Rational::of(rate.num, rate.den), is_stated});
  };
  add(stream.avg_frame_rate, states_rate);
  add(stream.r_frame_rate, false);
  return rates;
}

ClipTiming timing_of(const AVFormatContext& file, const AVStream& stream,
                     const std::vector<std::int64_t>& times, const std::string& name) {
  std::vector<KnownRate> rates = announced_rates(file, stream);
  if (times.size() > 1) {
    const Rational clock = Rational::of(stream.time_base.num, stream.time_base.den);
    return timing_of(times, clock, std::move(rates), name);
  }
  // Of a single picture containers may tell no more than their clock, but for a camera's.
  if (std::string_view(file.iformat->name) != "cine")
    std::erase_if(rates, [](const KnownRate& known) { return known.rate.value() > kMostPictures; });
  if (!rates.empty()) return of_rate(rates.front().rate);
  return {};
}

}  // namespace nutik::videos
