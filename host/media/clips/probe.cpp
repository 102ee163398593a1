#include "media/clips/probe.hpp"

#include <algorithm>

#include "media/clips/libav.hpp"

namespace nutik::clips {
namespace {

constexpr std::int64_t kSecondNs = 1'000'000'000;

std::optional<Transfer> transfer_of(AVColorTransferCharacteristic characteristic) {
  switch (characteristic) {
    case AVCOL_TRC_BT709:
    case AVCOL_TRC_SMPTE170M:
    case AVCOL_TRC_BT2020_10:
    case AVCOL_TRC_BT2020_12: return Transfer::bt709();
    case AVCOL_TRC_IEC61966_2_1: return Transfer::srgb();
    case AVCOL_TRC_GAMMA22: return Transfer::gamma(2.2);
    case AVCOL_TRC_GAMMA28: return Transfer::gamma(2.8);
    case AVCOL_TRC_LINEAR: return Transfer::linear();
    default: return std::nullopt;
  }
}

// Whether every time is where a constant rate puts it, but for the rounding to the container's clock.
bool fits(const std::vector<std::int64_t>& times, AVRational time_base, Rational rate) {
  for (std::size_t i = 0; i < times.size(); ++i) {
    // i / rate, in ticks of the time base.
    const auto ticks = static_cast<std::int64_t>(i) * static_cast<int128>(rate.denominator) * time_base.den;
    const std::int64_t expected = round_half_up(ticks, static_cast<int128>(rate.numerator) * time_base.num);
    if (std::abs(times[i] - times[0] - expected) > 1) return false;
  }
  return true;
}

ClipTiming timing_of(const AVStream& stream, std::vector<std::int64_t> times) {
  std::vector<Rational> candidates;
  for (const AVRational& rate : {stream.avg_frame_rate, stream.r_frame_rate}) {
    if (rate.num > 0 && rate.den > 0) candidates.push_back(Rational::of(rate.num, rate.den));
  }
  const bool timed = std::find(times.begin(), times.end(), AV_NOPTS_VALUE) == times.end();
  if (timed && times.size() > 1) {
    std::sort(times.begin(), times.end());
    // The rate that the first and last picture tell, for files that announce another or none.
    if (times.back() > times.front()) {
      const auto periods = static_cast<std::int64_t>(times.size()) - 1;
      candidates.push_back(Rational::of(periods * stream.time_base.den,
                                        (times.back() - times.front()) * stream.time_base.num));
    }
    for (const Rational& rate : candidates) {
      if (fits(times, stream.time_base, rate)) return {rate, {}};
    }
    ClipTiming timing;
    for (const std::int64_t time : times) {
      timing.starts_ns.push_back(
          round_half_up(static_cast<int128>(time - times[0]) * stream.time_base.num * kSecondNs,
                        stream.time_base.den));
    }
    return timing;
  }
  if (!candidates.empty()) return {candidates.front(), {}};
  return {};
}

}  // namespace

Probe probe(const std::filesystem::path& path, const std::optional<RawVideo>& raw) {
  const OpenedVideo opened = open_video(path, raw);
  const AVStream& stream = *opened.format->streams[opened.stream];
  const AVCodecParameters& codec = *stream.codecpar;
  Probe result;
  result.stream = opened.stream;
  result.shape = {static_cast<std::uint32_t>(codec.width), static_cast<std::uint32_t>(codec.height), 3};
  const AVPixFmtDescriptor* pixels = av_pix_fmt_desc_get(static_cast<AVPixelFormat>(codec.format));
  if (pixels == nullptr || codec.width <= 0 || codec.height <= 0) {
    throw InputError(format("{}: no decoder here knows its pictures", path.string()));
  }
  result.bits = static_cast<std::uint32_t>(pixels->comp[0].depth);
  result.is_grey = pixels->nb_components == 1 && (pixels->flags & AV_PIX_FMT_FLAG_PAL) == 0;
  result.transfer = transfer_of(codec.color_trc);

  std::vector<std::int64_t> times;
  const PacketPointer packet(av_packet_alloc());
  while (av_read_frame(opened.format.get(), packet.get()) >= 0) {
    const bool counts = packet->stream_index == opened.stream && (packet->flags & AV_PKT_FLAG_DISCARD) == 0;
    if (counts) times.push_back(packet->pts != AV_NOPTS_VALUE ? packet->pts : packet->dts);
    av_packet_unref(packet.get());
  }
  result.sample_count = times.size();
  if (!raw) result.timing = timing_of(stream, std::move(times));
  return result;
}

}  // namespace nutik::clips
