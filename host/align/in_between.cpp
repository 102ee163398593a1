#include "align/in_between.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstring>
#include <limits>

#include "capture/made_samples.hpp"
#include "system/parallel.hpp"

namespace nutik {
namespace {

constexpr float kSmall = 1e-6F;
constexpr std::uint32_t kGrid = 4;  // pixels from place to place where ways are chosen
constexpr std::uint32_t kRound = 5, kEvery = 3;  // pixels round such a place that are compared, and between them
constexpr float kSameWay = 0.5F;  // pixels: ways that differ by less are one
constexpr std::uint32_t kPlaces = PairMotion::kBlock / kGrid;  // on a block's side

}  // namespace

EvenGrey::EvenGrey(const CaptureFormat& format, std::uint32_t side)
    : format_(format), side_(side), width_(format.shape.width / side), height_(format.shape.height / side) {
  const auto lights = format.transfer.light_of_codes(format.white_code);
  for (std::uint32_t channel = 0; channel < format.shape.channels; ++channel) {
    const double share = format.shape.channels == 1 ? 1 : kLuma[channel];
    for (const double light : lights)
      looks_[channel].push_back(static_cast<float>(255 * share * Transfer::srgb().fraction_of(light)));
  }
}

void EvenGrey::take(std::span<const std::byte> raster, std::vector<std::uint8_t>& grey,
                    std::uint32_t max_threads) const {
  grey.resize(std::size_t{width_} * height_);
  const auto look = [&]<typename Code, std::uint32_t kChannels>(const Code* codes) {
    parallel_for(
        height_,
        [&](std::uint64_t y) {
          const auto look_of = [&](const Code* pixel) {
            float sum = 0;
            for (std::uint32_t channel = 0; channel < kChannels; ++channel) {
              if (pixel[channel] >= looks_[channel].size()) throw CodeAboveWhite(pixel[channel]);
              sum += looks_[channel][pixel[channel]];
            }
            return sum;
          };
          const float share = 1.0F / static_cast<float>(side_ * side_);
          for (std::uint32_t x = 0; x < width_; ++x) {
            float sum = 0;
            for (std::uint32_t j = 0; j < side_; ++j) {
              const Code* pixel =
                  codes + ((y * side_ + j) * format_.shape.width + std::size_t{x} * side_) * kChannels;
              for (std::uint32_t i = 0; i < side_; ++i, pixel += kChannels) sum += look_of(pixel);
            }
            grey[y * width_ + x] = static_cast<std::uint8_t>(sum * share + 0.5F);
          }
        },
        max_threads);
  };
  with_codes(format_.code_bytes, raster.data(), [&]<typename Code>(const Code* codes) {
    format_.shape.channels == 1 ? look.template operator()<Code, 1>(codes)
                                : look.template operator()<Code, 3>(codes);
  });
}

InBetween::InBetween(const CaptureFormat& format)
    : format_(format),
      grey_(format, 1),
      tables_(format.transfer, format.white_code),
      motion_(format.shape.width, format.shape.height) {
  for (const double light : format.transfer.light_of_codes(format.white_code))
    light_.push_back(static_cast<float>(LightTables::kWhite * light));
}

std::uint64_t InBetween::bytes(const CaptureFormat& format) {
  return PairMotion::bytes(format.shape.width, format.shape.height) +
         (2 * sizeof(Light) + sizeof(Chosen) / (kGrid * kGrid) + 1) * format.shape.pixel_count();
}

void InBetween::take(Picture& first, Picture& second, Picture& before, Picture& after) {
  first_ = first.raster;
  second_ = second.raster;
  const auto grey = [&](Picture& picture) -> const std::uint8_t* {
    if (picture.raster.empty()) return nullptr;
    if (picture.grey.empty()) grey_.take(picture.raster, picture.grey, ~0U);
    return picture.grey.data();
  };
  const GreyPictures pictures{grey(first), grey(second), grey(before), grey(after)};
  motion_.find(pictures, ~0U);
  motion_.find_bends(pictures, ~0U);
  grey_pictures_ = pictures;
  chosen_.assign(motion_.ways_.size() * kPlaces * kPlaces, {});
  chosen_shares_.assign(motion_.ways_.size(), 0);
  made_.assign(first_.begin(), first_.end());
  shares_.assign(motion_.ways_.size(), 0);
  with_codes(format_.code_bytes, first_.data(), [&](const auto* codes) { read_light(codes, first_light_); });
  with_codes(format_.code_bytes, second_.data(),
             [&](const auto* codes) { read_light(codes, second_light_); });
  taken_.clear();
  for (const Flight& flight : motion_.flights_) {
    Taken first = taken(flight.first, first_light_, second_light_);
    taken_.emplace_back(std::move(first), taken(flight.second, second_light_, first_light_));
  }
}

// Leaves in its place what the other picture shows there.
InBetween::Taken InBetween::taken(const Flight::Seen& seen, std::vector<Light>& lights,
                                  const std::vector<Light>& behind) const {
  Taken taken{seen.box, std::vector<Light>(seen.cover.size())};
  for (std::size_t i = 0; i < seen.cover.size(); ++i) {
    const std::size_t x = seen.box.x + i % seen.box.width - motion_.box_.x;
    const std::size_t y = seen.box.y + i / seen.box.width - motion_.box_.y;
    Light& light = lights[y * motion_.box_.width + x];
    const Light shown = light;
    light += seen.cover[i] * (behind[y * motion_.box_.width + x] - shown);
    taken.lights[i] = shown - (1 - seen.hides[i]) * light;
    taken.lights[i][3] = seen.hides[i];
  }
  return taken;
}

// Nothing outside of its box.
InBetween::Light InBetween::Taken::at(float x, float y) const {
  const float left = std::floor(x), top = std::floor(y), u = x - left, v = y - top;
  Light sum{};
  for (int j = 0; j < 2; ++j) {
    for (int i = 0; i < 2; ++i) {
      const auto column = static_cast<std::int64_t>(left) + i - box.x,
                 row = static_cast<std::int64_t>(top) + j - box.y;
      if (column < 0 || row < 0 || column >= box.width || row >= box.height) continue;
      sum += (i == 0 ? 1 - u : u) * (j == 0 ? 1 - v : v) *
             lights[static_cast<std::size_t>(row) * box.width + static_cast<std::size_t>(column)];
    }
  }
  return sum;
}

template <typename Code>
void InBetween::read_light(const Code* codes, std::vector<Light>& lights) const {
  const Rectangle& box = motion_.box_;
  const std::uint32_t channels = format_.shape.channels;
  lights.resize(std::size_t{box.width} * box.height);
  parallel_for(box.height, [&](std::uint64_t y) {
    const Code* pixel = codes + ((box.y + y) * format_.shape.width + box.x) * channels;
    Light* const to = lights.data() + y * box.width;
    for (std::uint32_t x = 0; x < box.width; ++x, pixel += channels) {
      to[x] = channels == 1 ? Light{light_[pixel[0]]}
                            : Light{light_[pixel[0]], light_[pixel[1]], light_[pixel[2]]};
    }
  });
}

InBetween::Light InBetween::at(const std::vector<Light>& lights, const Rectangle& box, float x, float y) {
  const auto left = static_cast<std::uint32_t>(x), top = static_cast<std::uint32_t>(y);
  const float u = x - static_cast<float>(left), v = y - static_cast<float>(top);
  const Light* const above = lights.data() + std::size_t{top} * box.width + left;
  const Light* const below = above + (top + 1 < box.height ? box.width : 0);
  const std::size_t next = left + 1 < box.width ? 1 : 0;
  return (1 - v) * ((1 - u) * above[0] + u * above[next]) + v * ((1 - u) * below[0] + u * below[next]);
}

// Put together of both pictures' flow at the same place (Jiang et al., "Super SloMo").
FlowVector InBetween::way_through(std::size_t pixel, float share) const {
  const FlowVector &there = motion_.forwards_.flow[pixel], &back = motion_.backwards_.flow[pixel];
  return {(1 - share) * there.x - share * back.x, (1 - share) * there.y - share * back.y};
}

// What the place shows in neither picture only passes, so it does not stay both where it comes from and where it
// goes to: still ground is not dragged along.
InBetween::Tried InBetween::tried(std::uint32_t x, std::uint32_t y, const FlowVector& more,
                                  float share) const {
  const Rectangle& box = motion_.box_;
  const auto& [first, second, before, after] = grey_pictures_;
  const auto apart = [](std::uint8_t a, std::uint8_t b) {
    const auto difference = static_cast<float>(a - b);
    return difference * difference;
  };
  float differs = 0, stays = 0, is_new = 0, samples = 0;
  std::array<float, 4> changes{};  // where it comes from and goes to, each in two pictures more
  for (std::uint32_t j = y - std::min(y, kRound); j < std::min(y + kRound, box.height); j += kEvery) {
    for (std::uint32_t i = x - std::min(x, kRound); i < std::min(x + kRound, box.width); i += kEvery) {
      const std::size_t pixel = std::size_t{j} * box.width + i;
      const FlowVector way = way_through(pixel, share), bent = motion_.bent(pixel, share);
      const auto place = [&](float part) {
        const auto inside = [](float at, std::uint32_t count) {
          return static_cast<std::uint32_t>(std::clamp(at + 0.5F, 0.0F, static_cast<float>(count - 1)));
        };
        const std::uint32_t at_x =
            inside(static_cast<float>(i) + bent.x + part * (way.x + more.x), box.width);
        const std::uint32_t at_y =
            inside(static_cast<float>(j) + bent.y + part * (way.y + more.y), box.height);
        return std::size_t{box.y + at_y} * format_.shape.width + box.x + at_x;
      };
      const std::size_t here = std::size_t{box.y + j} * format_.shape.width + box.x + i;
      const std::size_t from = place(-share), to = place(1 - share);
      stays += apart(first[here], second[here]);
      differs += apart(first[from], second[to]);
      is_new += std::min(std::min(apart(first[from], first[here]), apart(first[from], second[here])),
                         std::min(apart(second[to], first[here]), apart(second[to], second[here])));
      changes[0] += apart(first[from], second[from]);
      changes[1] += apart(first[from], (before ? before : second)[from]);
      changes[2] += apart(first[to], second[to]);
      changes[3] += apart(second[to], (after ? after : first)[to]);
      ++samples;
    }
  }
  const float moves = std::max(std::min(changes[0], changes[1]), std::min(changes[2], changes[3]));
  const float doubt = samples * PairMotion::kDoubt;
  const float dragged = std::max(is_new - moves, 0.0F),
              remains = std::max(stays, std::min(is_new, moves)) + doubt;
  // Half where the way explains no more than that nothing moves.
  return {(differs + dragged + doubt) / remains,
          believed_of((differs + doubt) / remains / 2) * believed_of(dragged / (is_new + doubt))};
}

// Takes the way that leaves least: that of both directions' mean, or of one alone.
void InBetween::choose_ways(std::uint32_t column, std::uint32_t row, float share) {
  const Rectangle& box = motion_.box_;
  for (std::uint32_t k = 0; k < kPlaces * kPlaces; ++k) {
    const std::uint32_t i = column * kPlaces + k % kPlaces, j = row * kPlaces + k / kPlaces;
    const std::uint32_t x = std::min(i * kGrid + kGrid / 2 - box.x, box.width - 1);
    const std::uint32_t y = std::min(j * kGrid + kGrid / 2 - box.y, box.height - 1);
    const std::size_t pixel = std::size_t{y} * box.width + x;
    const FlowVector &there = motion_.forwards_.flow[pixel], &back = motion_.backwards_.flow[pixel];
    const FlowVector both{there.x + back.x, there.y + back.y};  // by how much they disagree
    const std::array<FlowVector, 3> ways{
        {{}, {share * both.x, share * both.y}, {(share - 1) * both.x, (share - 1) * both.y}}};
    Chosen& chosen = chosen_[std::size_t{j} * motion_.columns_ * kPlaces + i];
    chosen = {};
    float least = std::numeric_limits<float>::max();
    for (const FlowVector& more : std::span(ways).first(length(both) < kSameWay ? 1 : ways.size())) {
      const Tried way = tried(x, y, more, share);
      if (way.left >= least) continue;
      least = way.left;
      chosen = {more, way.believed};
    }
  }
}

InBetween::Chosen InBetween::chosen_at(std::uint32_t x, std::uint32_t y) const {
  const std::uint32_t columns = motion_.columns_ * kPlaces, rows = motion_.rows_ * kPlaces;
  const float at_x = (static_cast<float>(x) + 0.5F) / kGrid - 0.5F,
              at_y = (static_cast<float>(y) + 0.5F) / kGrid - 0.5F;
  const float left = std::floor(at_x), top = std::floor(at_y);
  Chosen mean;
  for (const float row : {top, top + 1}) {
    for (const float column : {left, left + 1}) {
      const auto inside = [](float place, std::uint32_t count) {
        return static_cast<std::size_t>(std::clamp(place, 0.0F, static_cast<float>(count - 1)));
      };
      const float weight = (1 - std::abs(at_x - column)) * (1 - std::abs(at_y - row));
      const Chosen& chosen = chosen_[inside(row, rows) * columns + inside(column, columns)];
      mean.more.x += weight * chosen.more.x;
      mean.more.y += weight * chosen.more.y;
      mean.believed += weight * chosen.believed;
    }
  }
  return mean;
}

// Ways gain speed evenly (Xu et al., "Quadratic video interpolation").
InBetween::Light InBetween::moved(std::uint32_t x, std::uint32_t y, float share) const {
  const Rectangle& box = motion_.box_;
  const std::size_t i = std::size_t{y} * box.width + x;
  const float rest = 1 - share, right = static_cast<float>(box.width - 1),
              bottom = static_cast<float>(box.height - 1);
  const FlowVector bent = motion_.bent(i, share), mean = way_through(i, share);
  const Chosen chosen = chosen_at(box.x + x, box.y + y);
  const FlowVector way{mean.x + chosen.more.x, mean.y + chosen.more.y};
  const auto place = [&](float part) {
    return FlowVector{std::clamp(static_cast<float>(x) + bent.x + part * way.x, 0.0F, right),
                      std::clamp(static_cast<float>(y) + bent.y + part * way.y, 0.0F, bottom)};
  };
  const FlowVector a = place(-share), b = place(rest);
  const auto weight = [&](const PairMotion::Direction& direction, const FlowVector& at) {
    return direction
        .weights[static_cast<std::size_t>(at.y + 0.5F) * box.width + static_cast<std::size_t>(at.x + 0.5F)];
  };
  const PairMotion::Weight of_a = weight(motion_.forwards_, a), of_b = weight(motion_.backwards_, b);
  // What goes elsewhere is not here any more, or not yet, unless something that goes is there at both ends.
  const auto goes = [i](const PairMotion::Direction& direction) {
    return direction.weights[i].believed * direction.weights[i].agrees;
  };
  const float leaves = goes(motion_.forwards_), comes = goes(motion_.backwards_);
  const float first_seen = rest * (1 - leaves * (1 - comes) + kSmall);
  const float second_seen = share * (1 - comes * (1 - leaves) + kSmall);
  const Light line =
      (first_seen * first_light_[i] + second_seen * second_light_[i]) / (first_seen + second_seen);
  const float believed = chosen.believed * std::max(of_a.believed, of_b.believed);
  if (believed <= 0) return line;
  const float count_a = rest * of_a.agrees + kSmall, count_b = share * of_b.agrees + kSmall;
  const Light along =
      (count_a * at(first_light_, box, a.x, a.y) + count_b * at(second_light_, box, b.x, b.y)) /
      (count_a + count_b);
  return believed * along + (1 - believed) * line;
}

template <typename Code>
void InBetween::make_block(std::uint32_t column, std::uint32_t row, float share, Code* raster) const {
  constexpr std::uint32_t kBlock = PairMotion::kBlock;
  const std::uint32_t width = format_.shape.width, channels = format_.shape.channels;
  const std::uint32_t x = column * kBlock, count = std::min(kBlock, width - x), values = count * channels;
  const bool is_moved = motion_.ways_[std::size_t{row} * motion_.columns_ + column].is_moved;
  std::array<float, std::size_t{kBlock} * 3> lights;
  std::array<std::uint32_t, lights.size()> codes;
  for (std::uint32_t y = row * kBlock; y < std::min((row + 1) * kBlock, format_.shape.height); ++y) {
    const std::size_t begin = (std::size_t{y} * width + x) * channels;
    const auto *first = reinterpret_cast<const Code*>(first_.data()) + begin,
               *second = reinterpret_cast<const Code*>(second_.data()) + begin;
    if (share == 0 || share == 1) {
      std::memcpy(raster + begin, share == 0 ? first : second, values * sizeof(Code));
      continue;
    }
    if (is_moved) {
      for (std::uint32_t i = 0; i < count; ++i) {
        Light light = moved(x + i - motion_.box_.x, y - motion_.box_.y, share);
        for (std::size_t k = 0; k < taken_.size(); ++k) {
          const auto& [from, to] = taken_[k];
          const FlowVector gone = motion_.flights_[k].at(share), &way = motion_.flights_[k].way;
          const float from_x = static_cast<float>(x + i) - gone.x, from_y = static_cast<float>(y) - gone.y;
          const Light flies =
              (1 - share) * from.at(from_x, from_y) + share * to.at(from_x + way.x, from_y + way.y);
          light = (1 - flies[3]) * light + flies;
        }
        for (std::uint32_t channel = 0; channel < channels; ++channel) {
          lights[i * channels + channel] = std::clamp(light[channel], 0.0F, LightTables::kWhite);
        }
      }
    } else {
      for (std::uint32_t i = 0; i < values; ++i)
        lights[i] = (1 - share) * light_[first[i]] + share * light_[second[i]];
    }
    tables_.codes_of({lights.data(), values}, codes.data());
    for (std::uint32_t i = 0; i < values; ++i) raster[begin + i] = static_cast<Code>(codes[i]);
  }
}

// The nearest of the block's own steps; between two, where something moves, exactly there.
float InBetween::share_of(const PairMotion::Way& way, std::uint32_t step, std::uint32_t steps) {
  const std::uint32_t own = std::min<std::uint32_t>(way.steps, steps), halves = 2 * step * own;
  if (way.is_moved && halves % (2 * steps) == steps)
    return static_cast<float>(step) / static_cast<float>(steps);
  return static_cast<float>((halves + steps) / (2 * steps)) / static_cast<float>(own);
}

void InBetween::make(std::uint32_t step, std::uint32_t steps, std::span<std::byte> raster) {
  const auto each_block = [&](const auto& visit) {
    parallel_for(motion_.rows_, [&](std::uint64_t row) {
      for (std::uint32_t column = 0; column < motion_.columns_; ++column) {
        const std::size_t block = row * motion_.columns_ + column;
        visit(block, share_of(motion_.ways_[block], step, steps));
      }
    });
  };
  std::vector<std::uint8_t> is_new(motion_.ways_.size());
  each_block([&](std::size_t block, float share) {
    is_new[block] = motion_.ways_[block].is_moved && share != chosen_shares_[block];
    if (!is_new[block]) return;
    choose_ways(static_cast<std::uint32_t>(block % motion_.columns_),
                static_cast<std::uint32_t>(block / motion_.columns_), share);
    chosen_shares_[block] = share;
  });
  const auto is_near_new = [&](std::size_t block) {
    const std::size_t column = block % motion_.columns_, row = block / motion_.columns_;
    for (std::size_t y = row - (row > 0); y <= std::min<std::size_t>(row + 1, motion_.rows_ - 1); ++y) {
      for (std::size_t x = column - (column > 0);
           x <= std::min<std::size_t>(column + 1, motion_.columns_ - 1); ++x) {
        if (is_new[y * motion_.columns_ + x]) return true;
      }
    }
    return false;
  };
  each_block([&](std::size_t block, float share) {
    if (share == shares_[block] && !(motion_.ways_[block].is_moved && is_near_new(block))) return;
    shares_[block] = share;
    const auto column = static_cast<std::uint32_t>(block % motion_.columns_);
    const auto row = static_cast<std::uint32_t>(block / motion_.columns_);
    format_.code_bytes == 1 ? make_block(column, row, share, reinterpret_cast<std::uint8_t*>(made_.data()))
                            : make_block(column, row, share, reinterpret_cast<std::uint16_t*>(made_.data()));
  });
  std::ranges::copy(made_, raster.begin());
}

}  // namespace nutik
