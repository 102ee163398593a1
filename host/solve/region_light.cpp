#include "solve/region_light.hpp"

#include <algorithm>
#include <utility>

#include "imev/each_block.hpp"
#include "system/interruption.hpp"

namespace nutik {
namespace {

constexpr std::size_t kRun = 64;

using ChannelSums = std::array<CompensatedSum, 3>;

// Light of a region that one function exposes, as it is summed up.
struct Course {
  std::size_t region = 0;
  std::uint8_t tag = 0;
  std::vector<ChannelSums> changes;  // at each sample of the block
  std::vector<ChannelLight> light;   // of all samples so far
  ChannelSums plate;
};

// All regions' courses, and the weights that pixels have in them.
class Courses {
 public:
  Courses(const Mask& mask, const Mask* marks, const std::vector<LightRegion>& regions)
      : mask_(mask), pixels_(mask, marks), regions_(regions), weights_(regions.size()) {
    course_of_.assign(regions.size(), {});
    for (auto& courses : course_of_) courses.fill(kNone);
    for (std::uint64_t pixel = 0; pixel < mask.tags.size(); ++pixel) {
      if (pixel % mask.width == 0) check_interruption();
      for (std::size_t region = 0; region < regions.size(); ++region) {
        const double weight = pixels_.weight(regions[region], pixel);
        if (weight == 0.0) continue;
        weights_[region].add(weight);
        for_each_share(pixel, [&](std::uint8_t tag, double) { course(region, tag); });
      }
    }
  }

  // Calls visit(course, weight), weights of a region adding up to 1.
  template <typename Visit>
  void for_each(std::uint64_t pixel, Visit visit) {
    for (std::size_t region = 0; region < regions_.size(); ++region) {
      const double weight = pixels_.weight(regions_[region], pixel);
      if (weight == 0.0) continue;
      for_each_share(pixel, [&](std::uint8_t tag, double share) {
        visit(list[course_of_[region][tag]], weight * share / weights_[region].value());
      });
    }
  }

  // Whether any pixel of each tile is in a region.
  [[nodiscard]] std::vector<bool> wanted_tiles(const TileGrid& grid) const {
    std::vector<bool> wanted(grid.tile_count());
    for (std::uint64_t pixel = 0; pixel < mask_.tags.size(); ++pixel) {
      const bool is_in = std::ranges::any_of(
          regions_, [&](const LightRegion& region) { return pixels_.weight(region, pixel) != 0.0; });
      if (!is_in) continue;
      wanted[grid.tile_of(static_cast<std::uint32_t>(pixel % mask_.width),
                          static_cast<std::uint32_t>(pixel / mask_.width))] = true;
    }
    return wanted;
  }

  std::vector<Course> list;

 private:
  static constexpr std::size_t kNone = ~std::size_t{0};

  template <typename Visit>
  void for_each_share(std::uint64_t pixel, Visit visit) const {
    const auto shares = mask_.mixed.of(pixel);
    if (shares.empty()) visit(mask_.tags[pixel], 1.0);
    for (const Share& share : shares) {
      visit(static_cast<std::uint8_t>(share.of), static_cast<double>(share.size) / kWholeShare);
    }
  }

  void course(std::size_t region, std::uint8_t tag) {
    std::size_t& at = course_of_[region][tag];
    if (at != kNone) return;
    at = list.size();
    list.push_back({region, tag, {}, {}, {}});
  }

  const Mask& mask_;
  RegionPixels pixels_;
  const std::vector<LightRegion>& regions_;
  std::vector<CompensatedSum> weights_;                          // of each region's pixels
  std::vector<std::array<std::size_t, kMaskValues>> course_of_;  // by region and tag
};

// With what else the blocks hold that hold any of the samples.
SampleRange in_whole_blocks(const CaptureSource& capture, SampleRange samples) {
  SampleRange whole = samples;
  for (std::uint64_t block = 0; block < capture.block_count(); ++block) {
    const SampleRange held = capture.block_extent(block).range();
    if (held.last <= samples.first || held.first >= samples.last) continue;
    whole = {std::min(whole.first, held.first), std::max(whole.last, held.last)};
  }
  return whole;
}

}  // namespace

LightCourse::LightCourse(const Timeline& timeline, std::uint64_t first, std::vector<ChannelLight> light)
    : light_(std::move(light)) {
  edges_ns_.reserve(2 * light_.size() + 1);
  for (std::uint64_t k = 0; k < light_.size(); ++k) {
    edges_ns_.push_back(timeline.start_ns(first + k));
    edges_ns_.push_back(timeline.end_ns(first + k));
  }
  edges_ns_.push_back(timeline.reach_end_ns(first + light_.size() - 1));
  const std::size_t stretches = edges_ns_.size() - 1;
  runs_.reserve(stretches / kRun);
  for (std::size_t begin = 0; begin + kRun <= stretches; begin += kRun) {
    Run run{edges_ns_[begin], edges_ns_[begin + kRun]};
    std::array<CompensatedSum, 3> sums, moments;
    const auto half = static_cast<double>(run.end_ns - run.begin_ns) / 2;
    for (std::size_t i = begin; i < begin + kRun; ++i) {
      add_stretch(i, {run.begin_ns, run.end_ns, 1.0, 1.0}, sums);
      add_stretch(i, {run.begin_ns, run.end_ns, -half, half}, moments);
    }
    for (std::size_t channel = 0; channel < 3; ++channel) {
      run.light_ns[channel] = sums[channel].value();
      run.moment_ns2[channel] = moments[channel].value();
    }
    runs_.push_back(run);
  }
}

std::uint64_t LightCourse::bytes(std::uint64_t samples) {
  return samples * (sizeof(ChannelLight) + 2 * sizeof(std::int64_t)) + 2 * samples / kRun * sizeof(Run);
}

std::size_t LightCourse::stretch_at(std::int64_t time_ns) const {
  const auto behind = std::ranges::upper_bound(edges_ns_, time_ns);
  const auto at = behind - edges_ns_.begin() - 1;
  return static_cast<std::size_t>(std::clamp<std::ptrdiff_t>(at, 0, std::ssize(edges_ns_) - 2));
}

// What of a piece lies in a stretch.
void LightCourse::add_stretch(std::size_t stretch, const GainPiece& piece,
                              std::array<CompensatedSum, 3>& sums) const {
  const std::int64_t begin_ns = std::max(edges_ns_[stretch], piece.begin_ns);
  const std::int64_t end_ns = std::min(edges_ns_[stretch + 1], piece.end_ns);
  if (begin_ns >= end_ns) return;
  const ChannelLight& from = light_[stretch / 2];
  const bool is_ramp = stretch % 2 == 1 && stretch / 2 + 1 < light_.size();
  const ChannelLight& to = is_ramp ? light_[stretch / 2 + 1] : from;
  const auto length = static_cast<double>(edges_ns_[stretch + 1] - edges_ns_[stretch]);
  const double begin_share = static_cast<double>(begin_ns - edges_ns_[stretch]) / length;
  const double end_share = static_cast<double>(end_ns - edges_ns_[stretch]) / length;
  const double begin_gain = piece.at(begin_ns), end_gain = piece.at(end_ns);
  for (std::size_t channel = 0; channel < 3; ++channel) {
    const double rise = to[channel] - from[channel];
    const double begin = from[channel] + rise * begin_share, end = from[channel] + rise * end_share;
    // Simpson's rule, which is exact for the product of two straight lines.
    const double middle = (begin + end) * (begin_gain + end_gain);
    sums[channel].add(static_cast<double>(end_ns - begin_ns) *
                      (begin * begin_gain + middle + end * end_gain) / 6);
  }
}

ChannelLight LightCourse::integral_ns(std::span<const GainPiece> pieces) const {
  std::array<CompensatedSum, 3> sums;
  for (const GainPiece& piece : pieces) {
    if (piece.is_zero()) continue;
    const std::size_t last = stretch_at(piece.end_ns - 1);
    for (std::size_t i = stretch_at(piece.begin_ns); i <= last; ++i) {
      const std::size_t run = i / kRun;
      const bool is_whole = i % kRun == 0 && run < runs_.size() && runs_[run].begin_ns >= piece.begin_ns &&
                            runs_[run].end_ns <= piece.end_ns;
      if (!is_whole) {
        add_stretch(i, piece, sums);
        continue;
      }
      const auto length = static_cast<double>(piece.end_ns - piece.begin_ns);
      const auto span_ns = static_cast<double>(runs_[run].end_ns - runs_[run].begin_ns);
      const double begin_gain = piece.at(runs_[run].begin_ns),
                   slope = (piece.end_gain - piece.begin_gain) / length;
      for (std::size_t channel = 0; channel < 3; ++channel) {
        sums[channel].add((begin_gain + slope * span_ns / 2) * runs_[run].light_ns[channel]);
        sums[channel].add(slope * runs_[run].moment_ns2[channel]);
      }
      i += kRun - 1;
    }
  }
  return {sums[0].value(), sums[1].value(), sums[2].value()};
}

double RegionPixels::weight(const LightRegion& region, std::uint64_t pixel) const {
  if (region.within) {
    const Rectangle& within = *region.within;
    const std::uint64_t x = pixel % mask_.width, y = pixel / mask_.width;
    if (x - within.x >= within.width || y - within.y >= within.height)
      return 0.0;  // also left of it, and above
  }
  if (region.mark && marks_->tags[pixel] != *region.mark) return 0.0;
  if (!region.tag) return 1.0;
  const auto shares = mask_.mixed.of(pixel);
  if (shares.empty()) return mask_.tags[pixel] == *region.tag ? 1.0 : 0.0;
  const auto found = std::ranges::find(shares, *region.tag, &Share::of);
  return found == shares.end() ? 0.0 : static_cast<double>(found->size) / kWholeShare;
}

ChannelLight mean_light(const Picture& light, const RegionPixels& pixels, const LightRegion& region) {
  const auto values = light.values<double>();
  const std::uint32_t channels = light.shape.channels;
  ChannelSums sums;
  CompensatedSum weights;
  for (std::uint64_t pixel = 0; pixel < light.shape.pixel_count(); ++pixel) {
    const double weight = pixels.weight(region, pixel);
    if (weight == 0.0) continue;
    weights.add(weight);
    for (std::uint32_t channel = 0; channel < channels; ++channel)
      sums[channel].add(weight * values[pixel * channels + channel]);
  }
  ChannelLight mean{};
  for (std::uint32_t channel = 0; channel < channels; ++channel)
    mean[channel] = sums[channel].value() / weights.value();
  return mean;
}

MemoryNeeds region_light_needs(const CaptureSource& capture, const Mask& mask, const Mask* marks,
                               const std::vector<LightRegion>& regions, SampleRange samples) {
  std::uint64_t longest = 0;
  for (std::uint64_t block = 0; block < capture.block_count(); ++block)
    longest = std::max<std::uint64_t>(longest, capture.block_extent(block).sample_count);
  const std::uint64_t course_bytes =
      LightCourse::bytes(in_whole_blocks(capture, samples).size()) + longest * sizeof(ChannelSums);
  return {{"light of regions", Courses(mask, marks, regions).list.size() * course_bytes}};
}

std::vector<RegionLight> measure_regions(CaptureSource& capture, const Transfer& transfer, const Mask& mask,
                                         const Mask* marks, const std::vector<LightRegion>& regions,
                                         const Picture* plate, SampleRange samples,
                                         const ReportedProgress& progress) {
  const CaptureFormat& format = capture.format();
  const Timeline& timeline = capture.timeline();
  const std::uint32_t channels = format.shape.channels;
  const TileGrid grid(format.shape);
  const std::vector<double> light_of = transfer.light_of_all_codes(format.white_code, format.code_bytes);
  Courses courses(mask, marks, regions);
  const std::vector<bool> is_wanted = courses.wanted_tiles(grid);
  const auto wants = [&](std::uint64_t first, std::uint64_t last) {
    while (first < last && !is_wanted[first]) ++first;
    return first < last;
  };

  std::vector<CompensatedSum> white_ns(regions.size());
  std::vector<ChangeRecord> history;
  BlockCursor cursor(capture);
  const SampleRange read = in_whole_blocks(capture, samples);
  for (Course& course : courses.list) course.light.reserve(read.size());
  const auto add_pixel = [&](const BlockView& block, const std::vector<std::int64_t>& starts_ns,
                             std::uint64_t pixel) {
    courses.for_each(pixel, [&](Course& course, double weight) {
      ChannelLight before{};
      for (std::size_t r = 0; r < history.size(); ++r) {
        const ChangeRecord& record = history[r];
        bool is_white = false;
        for (std::uint32_t channel = 0; channel < channels; ++channel) {
          const double light = weight * light_of[record.codes[channel]];
          course.changes[record.sample][channel].add(light - before[channel]);
          before[channel] = light;
          is_white |= record.codes[channel] == format.white_code;
        }
        if (!is_white) continue;
        const std::uint32_t until =
            r + 1 < history.size() ? history[r + 1].sample : block.extent().sample_count;
        white_ns[course.region].add(weight *
                                    static_cast<double>(starts_ns[until] - starts_ns[record.sample]));
      }
    });
  };
  for (std::uint64_t number = 0; number < capture.block_count(); ++number) {
    const SampleRange held = capture.block_extent(number).range();
    if (held.last <= samples.first || held.first >= samples.last) continue;
    if (progress) progress(number, capture.block_count());
    const BlockView block = cursor.at(number, wants);
    std::vector<std::int64_t> starts_ns;
    for (std::uint64_t k = held.first; k < held.last; ++k) starts_ns.push_back(timeline.start_ns(k));
    starts_ns.push_back(timeline.reach_end_ns(held.last - 1));
    for (Course& course : courses.list) course.changes.assign(block.extent().sample_count, {});
    for (std::uint64_t tile = 0; tile < grid.tile_count(); ++tile) {
      if (!is_wanted[tile]) continue;
      check_interruption();
      const auto left = static_cast<std::uint32_t>(tile % grid.columns()) * kTileSide;
      const auto top = static_cast<std::uint32_t>(tile / grid.columns()) * kTileSide;
      for (std::uint32_t y = top; y < std::min(top + kTileSide, format.shape.height); ++y) {
        for (std::uint32_t x = left; x < std::min(left + kTileSide, format.shape.width); ++x) {
          const std::uint64_t pixel = std::uint64_t{y} * format.shape.width + x;
          block.read_history(tile, TileGrid::lane_of(x, y), history);
          add_pixel(block, starts_ns, pixel);
        }
      }
    }
    for (Course& course : courses.list) {
      ChannelSums sums;  // a block begins with all of its light
      for (const ChannelSums& change : course.changes) {
        ChannelLight light{};
        for (std::uint32_t channel = 0; channel < channels; ++channel) {
          sums[channel].add(change[channel].value());
          light[channel] = sums[channel].value();
        }
        course.light.push_back(light);
      }
    }
  }

  std::vector<RegionLight> measured(regions.size());
  const auto read_ns =
      static_cast<double>(timeline.reach_end_ns(read.last - 1) - timeline.start_ns(read.first));
  for (std::size_t region = 0; region < regions.size(); ++region) {
    measured[region].white_share = white_ns[region].value() / read_ns;
  }
  if (plate != nullptr) {
    const auto values = plate->values<double>();
    for (std::uint64_t pixel = 0; pixel < format.shape.pixel_count(); ++pixel) {
      courses.for_each(pixel, [&](Course& course, double weight) {
        for (std::uint32_t channel = 0; channel < channels; ++channel)
          course.plate[channel].add(weight * values[pixel * channels + channel]);
      });
    }
  }
  for (Course& course : courses.list) {
    RegionLight& region = measured[course.region];
    region.courses.emplace(course.tag, LightCourse(timeline, read.first, std::move(course.light)));
    if (plate != nullptr) {
      region.plate[course.tag] = {course.plate[0].value(), course.plate[1].value(), course.plate[2].value()};
    }
  }
  return measured;
}

}  // namespace nutik
