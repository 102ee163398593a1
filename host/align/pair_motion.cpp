#include "align/pair_motion.hpp"

#include <algorithm>
#include <bit>
#include <cmath>

#include "align/registrar.hpp"
#include "capture/made_samples.hpp"
#include "media/module.hpp"
#include "system/parallel.hpp"

namespace nutik {
namespace {

constexpr std::uint32_t kMarginBlocks = 8;     // round what changed: a patch is followed with its surroundings
constexpr float kBelieved = 0.5F, kFoundBack = 0.35F;  // a pixel away from where it came from, on average
constexpr float kHardlyBelieved = 0.02F;
constexpr double kSmooth = 1.42;  // pixels: steps that are this long or half of it look like none
constexpr std::uint8_t kMixedSteps = 4;
constexpr std::size_t kStrays = 3;  // blocks that may be faster than all others

// About exp(-pixels), for a tenth of the time.
float agreement_of(float pixels) {
  const float apart = 1 + pixels / 8, square = apart * apart, fourth = square * square;
  return 1 / (fourth * fourth);
}

// The blocks round one, with 1-2-1 along both sides.
template <typename Value>
float smoothed(const Value& value_at, std::int64_t column, std::int64_t row, std::int64_t columns, std::int64_t rows) {
  float sum = 0, weights = 0;
  for (std::int64_t y = std::max<std::int64_t>(row - 1, 0); y <= std::min(row + 1, rows - 1); ++y) {
    for (std::int64_t x = std::max<std::int64_t>(column - 1, 0); x <= std::min(column + 1, columns - 1); ++x) {
      const float weight = (x == column ? 2.0F : 1.0F) * (y == row ? 2.0F : 1.0F);
      sum += weight * value_at(x, y);
      weights += weight;
    }
  }
  return sum / weights;
}

}  // namespace

std::unique_ptr<FlowFinder> open_flow_finder() { return module<MotionModule>().open_flow(); }

PairMotion::PairMotion(std::uint32_t width, std::uint32_t height)
    : width_(width),
      height_(height),
      columns_((width + kBlock - 1) / kBlock),
      rows_((height + kBlock - 1) / kBlock),
      differ_(std::size_t{columns_} * rows_),
      ways_(differ_.size()) {
  for (Direction* way : {&forwards_, &backwards_}) way->believed.resize(differ_.size());
}

std::uint64_t PairMotion::bytes(std::uint32_t width, std::uint32_t height) {
  constexpr std::uint64_t kSearchBytes = 61;  // a pixel that flow is looked for at: its pyramids and variations
  return 2 * (2 * sizeof(FlowVector) + sizeof(Weight) + kSearchBytes) * std::uint64_t{width} * height;
}

std::uint32_t PairMotion::steps_for(double pixels) {
  const double steps = std::ceil(std::min(pixels, double{MadeSamples::kMost}) / kSmooth);
  return std::bit_ceil(std::max(static_cast<std::uint32_t>(steps), 1U));
}

bool PairMotion::is_cut() const {
  constexpr double kMostOfPicture = 0.5, kMostOfChange = 0.6;
  return static_cast<double>(changed_) > kMostOfPicture * static_cast<double>(differ_.size()) &&
         static_cast<double>(unfollowed_) > kMostOfChange * static_cast<double>(changed_);
}

void PairMotion::compare(const std::uint8_t* first, const std::uint8_t* second) {
  for (std::uint32_t row = 0; row < rows_; ++row) {
    const std::uint32_t end = std::min((row + 1) * kBlock, height_);
    std::vector<std::uint32_t> sums(columns_);
    for (std::uint32_t y = row * kBlock; y < end; ++y) {
      const std::uint8_t *a = first + std::size_t{y} * width_, *b = second + std::size_t{y} * width_;
      for (std::uint32_t x = 0; x < width_; ++x) {
        const int difference = a[x] - b[x];
        sums[x / kBlock] += static_cast<std::uint32_t>(difference * difference);
      }
    }
    for (std::uint32_t column = 0; column < columns_; ++column) {
      const std::uint32_t pixels = (end - row * kBlock) * (std::min((column + 1) * kBlock, width_) - column * kBlock);
      differ_[std::size_t{row} * columns_ + column] = static_cast<float>(sums[column]) / static_cast<float>(pixels);
    }
  }
}

// False where nothing changed, or pictures are too small to follow anything.
bool PairMotion::choose_box() {
  std::uint32_t left = columns_, right = 0, top = rows_, bottom = 0;
  for (const Flight& flight : flights_) {
    const auto block = [](float place, std::uint32_t count) {
      return static_cast<std::uint32_t>(std::clamp(place / kBlock, 0.0F, static_cast<float>(count - 1)));
    };
    const auto hold = [&](const Rectangle& box, FlowVector gone) {
      const float x = static_cast<float>(box.x) + gone.x, y = static_cast<float>(box.y) + gone.y;
      left = std::min(left, block(x, columns_));
      right = std::max(right, block(x + static_cast<float>(box.width), columns_) + 1);
      top = std::min(top, block(y, rows_));
      bottom = std::max(bottom, block(y + static_cast<float>(box.height), rows_) + 1);
    };
    hold(flight.second.box, {});
    for (const float share : {0.0F, 0.5F, 1.0F}) hold(flight.first.box, flight.at(share));
  }
  for (std::uint32_t row = 0; row < rows_; ++row) {
    for (std::uint32_t column = 0; column < columns_; ++column) {
      if (differ_[std::size_t{row} * columns_ + column] <= kNoise) continue;
      left = std::min(left, column);
      right = std::max(right, column + 1);
      top = std::min(top, row);
      bottom = std::max(bottom, row + 1);
    }
  }
  if (left >= right || std::min(width_, height_) < FlowFinder::kMinSide) return false;
  const auto with_margin = [](std::uint32_t first, std::uint32_t end, std::uint32_t count, std::uint32_t pixels) {
    const std::uint32_t begin = first > kMarginBlocks ? first - kMarginBlocks : 0;
    return std::pair(begin * kBlock, std::min(std::min(end + kMarginBlocks, count) * kBlock, pixels));
  };
  const auto [x, x_end] = with_margin(left, right, columns_, width_);
  const auto [y, y_end] = with_margin(top, bottom, rows_, height_);
  box_ = {x, y, x_end - x, y_end - y};
  return true;
}

void PairMotion::find(const GreyPictures& pictures, std::uint32_t max_threads) {
  const std::uint8_t *first = pictures.first, *second = pictures.second;
  changed_ = unfollowed_ = 0;
  fastest_ = 0;
  box_ = {0, 0, 0, 0};
  compare(first, second);
  flights_ = find_flights(pictures, width_, height_);
  const bool has_box = choose_box();
  for (std::size_t block = 0; block < differ_.size(); ++block) {
    const bool differs = differ_[block] > kNoise;
    ways_[block] = {differs ? kMixedSteps : std::uint8_t{1}, false};
    changed_ += differs ? 1 : 0;
  }
  unfollowed_ = changed_;
  if (!has_box) return flights_.clear();
  const std::size_t offset = std::size_t{box_.y} * width_ + box_.x;
  const GreyPlane a{first + offset, box_.width, box_.height, width_};
  const GreyPlane b{second + offset, box_.width, box_.height, width_};
  const std::size_t pixels = std::size_t{box_.width} * box_.height;
  parallel_for(
      2,
      [&](std::uint64_t i) {
        Direction& way = i == 0 ? forwards_ : backwards_;
        if (!way.finder) way.finder = open_flow_finder();
        way.flow.assign(pixels, FlowVector());
        way.weights.resize(pixels);
        way.finder->find(i == 0 ? a : b, i == 0 ? b : a, way.flow);
      },
      max_threads);
  weigh(a.pixels, b.pixels, forwards_, backwards_, max_threads);
  weigh(b.pixels, a.pixels, backwards_, forwards_, max_threads);
  std::vector<bool> is_flown(differ_.size());
  fly(is_flown);
  std::vector<float> ways;
  for (std::size_t block = 0; block < differ_.size(); ++block) {
    const auto column = static_cast<std::uint32_t>(block % columns_);
    const auto row = static_cast<std::uint32_t>(block / columns_);
    for (const Direction* way : {&forwards_, &backwards_}) {
      if (is_followed(*way, block)) ways.push_back(length(flow_of(*way, column, row)));
    }
    const bool is_known = is_flown[block] || is_followed(forwards_, block) || is_followed(backwards_, block);
    if (differ_[block] > kNoise && is_known) --unfollowed_;
  }
  if (ways.size() > kStrays) {
    std::ranges::nth_element(ways, ways.end() - static_cast<std::ptrdiff_t>(kStrays) - 1);
    fastest_ = std::max(fastest_, double{ways[ways.size() - kStrays - 1]});
  }
  mark(forwards_);
  mark(backwards_);
}

// A way that keeps its speed and direction leads as far on as it led here. Where most of the picture changed from the
// one beyond, as across a cut, motion from there is believed as far as it explains that.
void PairMotion::find_bends(const GreyPictures& pictures, std::uint32_t max_threads) {
  forwards_.bend.clear();
  backwards_.bend.clear();
  if (box_.width == 0) return;
  const std::size_t offset = std::size_t{box_.y} * width_ + box_.x;
  const auto plane = [&](const std::uint8_t* grey) {
    return GreyPlane{grey + offset, box_.width, box_.height, width_};
  };
  parallel_for(
      2,
      [&](std::uint64_t i) {
        Direction& way = i == 0 ? forwards_ : backwards_;
        const std::uint8_t* const beyond = i == 0 ? pictures.before : pictures.after;
        if (!beyond) return;
        const GreyPlane here = plane(i == 0 ? pictures.first : pictures.second), there = plane(beyond);
        way.bend.assign(way.flow.size(), FlowVector());
        way.finder->find(here, there, way.bend, FlowFinder::Detail::rough);
        double missed = kDoubt, changed = kDoubt;
        std::size_t changed_pixels = 0;
        for (std::uint32_t y = 0; y < box_.height; ++y) {
          for (std::uint32_t x = 0; x < box_.width; ++x) {
            const FlowVector& back = way.bend[std::size_t{y} * box_.width + x];
            const auto to = [](std::uint32_t from, float gone, std::uint32_t count) {
              return static_cast<std::size_t>(
                  std::clamp(static_cast<float>(from) + gone + 0.5F, 0.0F, static_cast<float>(count - 1)));
            };
            const int shown = here.pixels[std::size_t{y} * width_ + x];
            const int stays = there.pixels[std::size_t{y} * width_ + x] - shown;
            const int moved = there.pixels[to(y, back.y, box_.height) * width_ + to(x, back.x, box_.width)] - shown;
            if (static_cast<float>(stays * stays) <= kDoubt) continue;
            ++changed_pixels;
            changed += stays * stays;
            missed += moved * moved;
          }
        }
        const bool is_most = 2 * changed_pixels > way.bend.size();
        const float believed = is_most ? believed_of(static_cast<float>(missed / changed)) : 1;
        for (std::size_t pixel = 0; pixel < way.bend.size(); ++pixel) {
          FlowVector& bend = way.bend[pixel];
          bend = {believed * (way.flow[pixel].x + bend.x), believed * (way.flow[pixel].y + bend.y)};
        }
      },
      max_threads);
  if (forwards_.bend.empty()) forwards_.bend = backwards_.bend;
  if (backwards_.bend.empty()) backwards_.bend = forwards_.bend;
}

FlowVector PairMotion::bent(std::size_t pixel, float share) const {
  if (forwards_.bend.empty()) return {};
  const FlowVector &first = forwards_.bend[pixel], &second = backwards_.bend[pixel];
  const float part = share * (1 - share) / 2;
  return {part * std::lerp(first.x, second.x, share), part * std::lerp(first.y, second.y, share)};
}

// Things that fly: blocks that they leave and come to, those on their way, and nothing of them is left to dense flow.
void PairMotion::fly(std::vector<bool>& is_flown) {
  for (const Flight& flight : flights_) {
    const FlowVector last = {flight.way.x + flight.bend.x / 2, flight.way.y + flight.bend.y / 2};
    const FlowVector begin = {flight.way.x - flight.bend.x / 2, flight.way.y - flight.bend.y / 2};
    const float fastest = std::max(length(begin), length(last));
    const bool is_believed = flight.believed > kBelieved;
    if (is_believed) fastest_ = std::max(fastest_, double{fastest});
    for (const auto& [seen, way] : {std::pair(&flight.first, &forwards_), std::pair(&flight.second, &backwards_)}) {
      for (std::size_t i = 0; i < seen->cover.size(); ++i) {
        const std::size_t x = seen->box.x + i % seen->box.width, y = seen->box.y + i / seen->box.width;
        const std::size_t block = y / kBlock * columns_ + x / kBlock;
        is_flown[block] = is_flown[block] || (is_believed && seen->cover[i] > kBelieved);
        way->weights[(y - box_.y) * box_.width + x - box_.x].believed *= 1 - seen->cover[i];
      }
    }
    const auto steps = static_cast<std::uint8_t>(steps_for(fastest));
    const auto places = static_cast<std::uint32_t>(2 * fastest / kBlock) + 1;
    for (std::uint32_t place = 0; place <= places; ++place) {
      const FlowVector gone = flight.at(static_cast<float>(place) / static_cast<float>(places));
      const auto blocks = [&](std::uint32_t begin_pixel, float moved, std::uint32_t pixels, std::uint32_t count) {
        const auto at = [&](float pixel) {
          return static_cast<std::uint32_t>(std::clamp(pixel / kBlock, 0.0F, static_cast<float>(count - 1)));
        };
        const float place_of = static_cast<float>(begin_pixel) + moved;
        return std::pair(at(place_of - kBlock / 2), at(place_of + static_cast<float>(pixels) + kBlock / 2));
      };
      const Rectangle& box = flight.first.box;
      const auto [left, right] = blocks(box.x, gone.x, box.width, columns_);
      const auto [top, bottom] = blocks(box.y, gone.y, box.height, rows_);
      for (std::uint32_t row = top; row <= bottom; ++row) {
        for (std::uint32_t column = left; column <= right; ++column) {
          const bool is_in_box = column * kBlock >= box_.x && column * kBlock < box_.x + box_.width &&
                                 row * kBlock >= box_.y && row * kBlock < box_.y + box_.height;
          Way& passed = ways_[std::size_t{row} * columns_ + column];
          if (is_in_box) passed = {std::max(passed.is_moved ? passed.steps : std::uint8_t{1}, steps), true};
        }
      }
    }
  }
}

bool PairMotion::is_followed(const Direction& way, std::size_t block) {
  return way.believed[block] > kBelieved && way.agrees[block] > kFoundBack;
}

FlowVector PairMotion::flow_of(const Direction& way, std::uint32_t column, std::uint32_t row) const {
  const std::uint32_t x = std::min(column * kBlock + kBlock / 2, width_ - 1) - box_.x;
  const std::uint32_t y = std::min(row * kBlock + kBlock / 2, height_ - 1) - box_.y;
  return x < box_.width && y < box_.height ? way.flow[std::size_t{y} * box_.width + x] : FlowVector();
}

// How far both directions agree, and what following this one leaves of the difference. `from` and `to` point to the
// box.
void PairMotion::weigh(const std::uint8_t* from, const std::uint8_t* to, Direction& way, const Direction& back,
                       std::uint32_t max_threads) {
  way.missed.assign(differ_.size(), 0);
  way.agrees.assign(differ_.size(), 0);
  const float right = static_cast<float>(box_.width - 1), bottom = static_cast<float>(box_.height - 1);
  const std::uint32_t first_row = box_.y / kBlock, rows = (box_.height + kBlock - 1) / kBlock;
  parallel_for(
      rows,
      [&](std::uint64_t strip) {
        const auto begin = static_cast<std::uint32_t>(strip) * kBlock, end = std::min(begin + kBlock, box_.height);
        const std::size_t first_block = (first_row + strip) * columns_ + box_.x / kBlock;
        float *const missed = way.missed.data() + first_block, *const agrees = way.agrees.data() + first_block;
        for (std::uint32_t y = begin; y < end; ++y) {
          const std::size_t row = std::size_t{y} * box_.width;
          for (std::uint32_t x = 0; x < box_.width; ++x) {
            const FlowVector& flow = way.flow[row + x];
            const float to_x = std::clamp(static_cast<float>(x) + flow.x, 0.0F, right);
            const float to_y = std::clamp(static_cast<float>(y) + flow.y, 0.0F, bottom);
            const auto left = static_cast<std::uint32_t>(to_x), top = static_cast<std::uint32_t>(to_y);
            const float u = to_x - static_cast<float>(left), v = to_y - static_cast<float>(top);
            const std::uint8_t* const above = to + std::size_t{top} * width_ + left;
            const std::uint8_t* const below = above + (top + 1 < box_.height ? width_ : 0);
            const std::size_t next = left + 1 < box_.width ? 1 : 0;
            const float grey = (1 - v) * ((1 - u) * above[0] + u * above[next]) +
                               v * ((1 - u) * below[0] + u * below[next]);
            const float difference = grey - from[std::size_t{y} * width_ + x];
            missed[x / kBlock] += difference * difference;
            const FlowVector& returned = back.flow[std::size_t{top + (v >= 0.5F && top + 1 < box_.height ? 1 : 0)} *
                                                       box_.width + left + (u >= 0.5F ? next : 0)];
            const float agreement = agreement_of(length({flow.x + returned.x, flow.y + returned.y}));
            way.weights[row + x].agrees = agreement;
            agrees[x / kBlock] += agreement;
          }
        }
        for (std::uint32_t column = 0; column * kBlock < box_.width; ++column) {
          const std::uint32_t width = std::min((column + 1) * kBlock, box_.width) - column * kBlock;
          missed[column] /= static_cast<float>((end - begin) * width);
          agrees[column] /= static_cast<float>((end - begin) * width);
        }
      },
      max_threads);
  believe(way, max_threads);
}

void PairMotion::believe(Direction& way, std::uint32_t max_threads) {
  std::ranges::fill(way.believed, 0.0F);
  const std::uint32_t first_column = box_.x / kBlock, first_row = box_.y / kBlock;
  const std::uint32_t columns = (box_.width + kBlock - 1) / kBlock, rows = (box_.height + kBlock - 1) / kBlock;
  const auto in_box = [&](const std::vector<float>& values) {
    return [&, all = values.data()](std::int64_t x, std::int64_t y) {
      return all[static_cast<std::size_t>(first_row + y) * columns_ + static_cast<std::size_t>(first_column + x)];
    };
  };
  for (std::uint32_t row = 0; row < rows; ++row) {
    for (std::uint32_t column = 0; column < columns; ++column) {
      const float left = smoothed(in_box(way.missed), column, row, columns, rows);
      const float differs = smoothed(in_box(differ_), column, row, columns, rows);
      way.believed[std::size_t{first_row + row} * columns_ + first_column + column] =
          believed_of((left + kDoubt) / (differs + kDoubt));
    }
  }
  // Between the middles of blocks in a straight line.
  parallel_for(
      box_.height,
      [&](std::uint64_t y) {
        const float at_y = (static_cast<float>(y) + 0.5F) / kBlock - 0.5F;
        const auto above = static_cast<std::int64_t>(std::floor(at_y));
        const float v = at_y - static_cast<float>(above);
        const auto row = [&](std::int64_t r) {
          const auto inside = static_cast<std::size_t>(std::clamp<std::int64_t>(r, 0, rows - 1));
          return way.believed.data() + (first_row + inside) * columns_ + first_column;
        };
        const float *upper = row(above), *lower = row(above + 1);
        Weight* const weights = way.weights.data() + y * box_.width;
        for (std::uint32_t x = 0; x < box_.width; ++x) {
          const float at_x = (static_cast<float>(x) + 0.5F) / kBlock - 0.5F;
          const auto left = static_cast<std::int64_t>(std::floor(at_x));
          const float u = at_x - static_cast<float>(left);
          const auto l = static_cast<std::size_t>(std::max<std::int64_t>(left, 0));
          const auto r = static_cast<std::size_t>(std::min<std::int64_t>(left + 1, columns - 1));
          weights[x].believed = (1 - v) * ((1 - u) * upper[l] + u * upper[r]) + v * ((1 - u) * lower[l] + u * lower[r]);
        }
      },
      max_threads);
}

// Blocks that something moves through.
void PairMotion::mark(const Direction& way) {
  const auto columns = static_cast<std::int64_t>(columns_), rows = static_cast<std::int64_t>(rows_);
  for (std::int64_t row = 0; row < rows; ++row) {
    for (std::int64_t column = 0; column < columns; ++column) {
      if (way.believed[static_cast<std::size_t>(row * columns + column)] <= kHardlyBelieved) continue;
      const FlowVector flow = flow_of(way, static_cast<std::uint32_t>(column), static_cast<std::uint32_t>(row));
      const auto blocks = static_cast<std::int64_t>(length(flow) / kBlock) + 1;
      const auto steps = static_cast<std::uint8_t>(steps_for(length(flow)));
      for (std::int64_t block = 0; block <= blocks; ++block) {
        const float share = static_cast<float>(block) / static_cast<float>(blocks) / kBlock;
        const std::int64_t x = column + std::lround(flow.x * share), y = row + std::lround(flow.y * share);
        for (std::int64_t j = std::max<std::int64_t>(y - 1, 0); j <= std::min(y + 1, rows - 1); ++j) {
          for (std::int64_t i = std::max<std::int64_t>(x - 1, 0); i <= std::min(x + 1, columns - 1); ++i) {
            const bool is_in_box = i * kBlock >= box_.x && i * kBlock < box_.x + box_.width &&
                                   j * kBlock >= box_.y && j * kBlock < box_.y + box_.height;
            Way& passed = ways_[static_cast<std::size_t>(j * columns + i)];
            if (is_in_box) passed = {std::max(passed.is_moved ? passed.steps : std::uint8_t{1}, steps), true};
          }
        }
      }
    }
  }
}

}  // namespace nutik
