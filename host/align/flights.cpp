#include "align/flights.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdlib>
#include <limits>
#include <optional>

namespace nutik {
namespace {

constexpr int kStandsOut = 16;  // codes of 255 that a thing differs by from what is seen at its place otherwise
constexpr std::size_t kMinThing = 8;     // fewer are noise that a codec left
constexpr std::size_t kMostThings = 24;   // of each picture: those that stand out most
constexpr std::uint32_t kMostOfSide = 4;  // things as long as this part of the shorter side fill the picture
constexpr std::uint64_t kMostOfPicture = 16;
constexpr float kMostTurned = 0.6F;  // of both ways together: so different are not those of one thing
constexpr int kReach = 2;        // pixels round a thing that show its blurred edge
constexpr std::int64_t kTried = 3;  // pixels round the difference of middles

struct Thing {
  std::vector<std::uint32_t> pixels;
  std::uint32_t left = 0, top = 0, right = 0, bottom = 0;  // the last two lie in it
  std::uint64_t stands_out = 0;
  float x = 0, y = 0;  // its middle
};

// A thing of a picture that may be one of the next.
struct Step {
  std::size_t from = 0, to = 0;
  FlowVector way;
  float left = 0;  // of what changed, that the way does not explain
  bool is_apart = true;  // it goes further than it is large
};

FlowVector operator-(const FlowVector& a, const FlowVector& b) { return {a.x - b.x, a.y - b.y}; }

class FlightSearch {
 public:
  FlightSearch(const GreyPictures& pictures, std::uint32_t width, std::uint32_t height)
      : pictures_(pictures), width_(width), height_(height), stands_out_(std::size_t{width} * height) {}

  [[nodiscard]] std::vector<Flight> find() {
    const auto& [first, second, before, after] = pictures_;
    if (!before && !after) return {};
    const std::vector<Thing> from = things_in(first, second, before, after);
    if (from.empty()) return {};
    const std::vector<Thing> to = things_in(second, first, after, before);
    if (to.empty()) return {};
    std::vector<Step> steps = steps_between(first, from, second, to);
    if (steps.empty()) return {};
    std::vector<Step> in, out;  // those that lead to the first picture's things, and on from the second's
    if (before) in = steps_between(before, things_in(before, first, second, nullptr), first, from);
    if (after) out = steps_between(second, to, after, things_in(after, second, first, nullptr));
    return chosen(from, to, steps, in, out);
  }

 private:
  // What `shown` alone shows: `other` and one of two more, where there are such, agree on something else.
  std::vector<Thing> things_in(const std::uint8_t* shown, const std::uint8_t* other, const std::uint8_t* third,
                               const std::uint8_t* fourth) {
    const std::size_t count = stands_out_.size();
    std::ranges::fill(stands_out_, std::uint8_t{0});
    const auto apart = [](std::uint8_t a, std::uint8_t b) {
      return static_cast<std::uint8_t>(std::max(a, b) - std::min(a, b));
    };
    for (const std::uint8_t* more : {third, fourth}) {
      if (!more) continue;
      for (std::size_t i = 0; i < count; ++i) {
        const std::uint8_t here = std::min(apart(shown[i], other[i]), apart(shown[i], more[i]));
        const auto others = static_cast<std::uint8_t>(2 * std::min(apart(other[i], more[i]), std::uint8_t{127}));
        const auto clear = static_cast<std::uint8_t>(std::max(here, others) - others);
        stands_out_[i] = std::max(stands_out_[i], clear);
      }
    }
    for (std::uint8_t& value : stands_out_) value = value >= kStandsOut ? value : std::uint8_t{0};
    const auto standing_out = static_cast<std::uint64_t>(
        std::ranges::count_if(stands_out_, [](std::uint8_t value) { return value > 0; }));
    std::vector<Thing> things;
    if (standing_out * kMostOfPicture > count) return things;  // a picture that moves as a whole
    for (std::size_t i = 0; i < count; ++i) {
      if (stands_out_[i] == 0) continue;
      Thing thing = thing_at(static_cast<std::uint32_t>(i));
      const std::uint32_t most = std::min(width_, height_) / kMostOfSide;
      if (thing.pixels.size() >= kMinThing && std::max(thing.right - thing.left, thing.bottom - thing.top) < most)
        things.push_back(std::move(thing));
    }
    std::ranges::stable_sort(things, std::ranges::greater(), &Thing::stands_out);
    if (things.size() > kMostThings) things.resize(kMostThings);
    std::erase_if(things, [&](const Thing& thing) { return hardly_moves(shown, other, thing); });
    return things;
  }

  // All that hangs together with a pixel, over a gap of one. What is taken does not stand out any more.
  Thing thing_at(std::uint32_t start) {
    Thing thing;
    thing.left = thing.right = start % width_;
    thing.top = thing.bottom = start / width_;
    std::vector<std::uint32_t> waiting{start};
    const auto take = [&](std::uint32_t pixel) {
      thing.stands_out += stands_out_[pixel];
      stands_out_[pixel] = 0;
    };
    take(start);
    double sum_x = 0, sum_y = 0;
    while (!waiting.empty()) {
      const std::uint32_t pixel = waiting.back(), x = pixel % width_, y = pixel / width_;
      waiting.pop_back();
      thing.pixels.push_back(pixel);
      thing.left = std::min(thing.left, x);
      thing.right = std::max(thing.right, x);
      thing.top = std::min(thing.top, y);
      thing.bottom = std::max(thing.bottom, y);
      sum_x += x;
      sum_y += y;
      for (std::uint32_t j = y - std::min(y, 2U); j <= std::min(y + 2, height_ - 1); ++j) {
        for (std::uint32_t i = x - std::min(x, 2U); i <= std::min(x + 2, width_ - 1); ++i) {
          const std::uint32_t next = j * width_ + i;
          if (stands_out_[next] == 0) continue;
          take(next);
          waiting.push_back(next);
        }
      }
    }
    const auto count = static_cast<double>(thing.pixels.size());
    thing.x = static_cast<float>(sum_x / count);
    thing.y = static_cast<float>(sum_y / count);
    return thing;
  }

  // What remains, of what changed at the thing's place, between it and `to` so many pixels away. Nothing of what leaves
  // the picture is explained.
  [[nodiscard]] float left_of(const std::uint8_t* from, const std::uint8_t* to, const Thing& thing, std::int64_t right,
                              std::int64_t down) const {
    double left = 0, changed = 0;
    for (const std::uint32_t pixel : thing.pixels) {
      const std::int64_t x = pixel % width_ + right, y = pixel / width_ + down;
      const double change = from[pixel] - to[pixel];
      const bool is_inside = x >= 0 && y >= 0 && x < width_ && y < height_;
      const double rest = is_inside ? from[pixel] - to[y * width_ + x] : change;
      changed += change * change;
      left += rest * rest;
    }
    return static_cast<float>(left / std::max(changed, 1.0));
  }

  // The way from one thing to another, if both may be one.
  [[nodiscard]] std::optional<Step> step(const std::uint8_t* first, const Thing& from, const std::uint8_t* second,
                                         const Thing& to) const {
    const std::size_t larger = std::max(from.pixels.size(), to.pixels.size());
    const bool is_apart = from.right < to.left || to.right < from.left || from.bottom < to.top || to.bottom < from.top;
    if (larger > 2 * std::min(from.pixels.size(), to.pixels.size())) return std::nullopt;
    const std::int64_t right = std::lround(to.x - from.x), down = std::lround(to.y - from.y);
    std::int64_t best_right = right, best_down = down;
    Step found;
    found.is_apart = is_apart;
    found.left = std::numeric_limits<float>::max();
    for (std::int64_t j = -kTried; j <= kTried; ++j) {
      for (std::int64_t i = -kTried; i <= kTried; ++i) {
        const float left = left_of(first, second, from, right + i, down + j);
        if (left >= found.left) continue;
        found.left = left;
        best_right = right + i;
        best_down = down + j;
      }
    }
    const float back = left_of(second, first, to, -best_right, -best_down);
    // The least of a parabola through three.
    const auto part = [&](std::int64_t i, std::int64_t j) {
      const float low = left_of(first, second, from, best_right - i, best_down - j);
      const float high = left_of(first, second, from, best_right + i, best_down + j);
      const float curve = low + high - 2 * found.left;
      return curve > 0 ? std::clamp((low - high) / (2 * curve), -0.5F, 0.5F) : 0.0F;
    };
    found.way = {static_cast<float>(best_right) + part(1, 0), static_cast<float>(best_down) + part(0, 1)};
    found.left = std::max(found.left, back);
    return 1 - found.left > kExplainsLittle ? std::optional(found) : std::nullopt;
  }

  // An edge that trembles, or a thing that goes no further than dense flow follows.
  [[nodiscard]] bool hardly_moves(const std::uint8_t* shown, const std::uint8_t* other, const Thing& thing) const {
    for (std::int64_t j = -kTried; j <= kTried; ++j) {
      for (std::int64_t i = -kTried; i <= kTried; ++i) {
        if (1 - left_of(shown, other, thing, i, j) > kExplainsLittle) return true;
      }
    }
    return false;
  }

  [[nodiscard]] std::vector<Step> steps_between(const std::uint8_t* first, const std::vector<Thing>& from,
                                                const std::uint8_t* second, const std::vector<Thing>& to) const {
    std::vector<Step> steps;
    for (std::size_t i = 0; i < from.size(); ++i) {
      for (std::size_t j = 0; j < to.size(); ++j) {
        std::optional<Step> found = step(first, from[i], second, to[j]);
        if (!found) continue;
        found->from = i;
        found->to = j;
        steps.push_back(*found);
      }
    }
    return steps;
  }

  // By how much ways differ: 0 … 1.
  static float turn(const FlowVector& a, const FlowVector& b) { return length(a - b) / (length(a) + length(b)); }

  // Each thing goes one way: first the one that explains most and goes on before or behind. A way that no other picture
  // confirms is none. What goes no further than it is large is left to dense flow.
  [[nodiscard]] std::vector<Flight> chosen(const std::vector<Thing>& from, const std::vector<Thing>& to,
                                           const std::vector<Step>& steps, const std::vector<Step>& in,
                                           const std::vector<Step>& out) const {
    struct Candidate {
      const Step* step;
      const Step *before = nullptr, *after = nullptr;
      float cost = 0;
    };
    std::vector<Candidate> candidates;
    for (const Step& step : steps) {
      Candidate candidate{&step};
      float before = kMostTurned, after = kMostTurned;
      const auto take = [&](const Step& other, float& least, const Step*& taken) {
        const float turned = turn(step.way, other.way);
        if (turned >= least) return;
        least = turned;
        taken = &other;
      };
      for (const Step& other : in) {
        if (other.to == step.from) take(other, before, candidate.before);
      }
      for (const Step& other : out) {
        if (other.from == step.to) take(other, after, candidate.after);
      }
      candidate.cost = step.left + (before + after) / 2;
      candidates.push_back(candidate);
    }
    std::ranges::stable_sort(candidates, {}, &Candidate::cost);
    std::vector<bool> is_from_taken(from.size()), is_to_taken(to.size());
    std::vector<Flight> flights;
    for (const Candidate& candidate : candidates) {
      const Step& step = *candidate.step;
      if (is_from_taken[step.from] || is_to_taken[step.to]) continue;
      if (!candidate.before && !candidate.after) continue;
      is_from_taken[step.from] = is_to_taken[step.to] = true;
      if (!step.is_apart) continue;
      Flight flight;
      flight.way = step.way;
      float known = 0;
      FlowVector bend;
      if (candidate.before) {
        bend = step.way - candidate.before->way;
        ++known;
      }
      if (candidate.after) {
        const FlowVector more = candidate.after->way - step.way;
        bend = {bend.x + more.x, bend.y + more.y};
        ++known;
      }
      if (known > 0) flight.bend = {bend.x / known, bend.y / known};
      flight.believed = believed_of(step.left);
      flight.first = seen(from[step.from], pictures_.first, pictures_.second, flight.believed);
      flight.second = seen(to[step.to], pictures_.second, pictures_.first, flight.believed);
      flights.push_back(std::move(flight));
    }
    return flights;
  }

  [[nodiscard]] Flight::Seen seen(const Thing& thing, const std::uint8_t* shown, const std::uint8_t* behind,
                                  float believed) const {
    constexpr std::uint32_t kMargin = kReach + 1;
    Flight::Seen seen;
    seen.box.x = thing.left - std::min(thing.left, kMargin);
    seen.box.y = thing.top - std::min(thing.top, kMargin);
    seen.box.width = std::min(thing.right + kMargin + 1, width_) - seen.box.x;
    seen.box.height = std::min(thing.bottom + kMargin + 1, height_) - seen.box.y;
    const auto width = static_cast<std::int64_t>(seen.box.width), height = static_cast<std::int64_t>(seen.box.height);
    std::vector<float> inside(static_cast<std::size_t>(width * height));
    double changed = 0;
    for (const std::uint32_t pixel : thing.pixels) {
      inside[(pixel / width_ - seen.box.y) * seen.box.width + pixel % width_ - seen.box.x] = 1;
      changed += std::pow(shown[pixel] - behind[pixel], 2);
    }
    const auto contrast = static_cast<float>(std::sqrt(changed / static_cast<double>(thing.pixels.size())));
    const auto over = [&](const std::vector<float>& values, int reach, auto&& combine, float start) {
      std::vector<float> result(values.size());
      for (std::int64_t y = 0; y < height; ++y) {
        for (std::int64_t x = 0; x < width; ++x) {
          float value = start;
          for (std::int64_t j = y - reach; j <= y + reach; ++j) {
            for (std::int64_t i = x - reach; i <= x + reach; ++i) {
              const bool is_in = i >= 0 && j >= 0 && i < width && j < height;
              value = combine(value, is_in ? values[static_cast<std::size_t>(j * width + i)] : 0.0F);
            }
          }
          result[static_cast<std::size_t>(y * width + x)] = value;
        }
      }
      return result;
    };
    const auto most = [](float a, float b) { return std::max(a, b); };
    const auto least = [](float a, float b) { return std::min(a, b); };
    const auto sum = [](float a, float b) { return a + b; };
    const std::vector<float> wide = over(inside, kReach, most, 0);
    const std::vector<float> core = over(wide, kReach + 1, least, 1);  // what lies within it, whatever it looks like
    seen.cover = over(wide, 1, sum, 0);
    seen.hides.resize(seen.cover.size());
    for (std::size_t i = 0; i < seen.cover.size(); ++i) {
      const std::size_t x = seen.box.x + i % seen.box.width, y = seen.box.y + i / seen.box.width;
      const std::size_t pixel = y * width_ + x;
      const float differs = static_cast<float>(std::abs(shown[pixel] - behind[pixel])) / std::max(contrast, 1.0F);
      seen.cover[i] *= believed / 9;
      seen.hides[i] = seen.cover[i] * std::max(std::min(differs, 1.0F), core[i]);
    }
    return seen;
  }

  const GreyPictures& pictures_;
  std::uint32_t width_, height_;
  std::vector<std::uint8_t> stands_out_;
};

}  // namespace

std::vector<Flight> find_flights(const GreyPictures& pictures, std::uint32_t width, std::uint32_t height) {
  return FlightSearch(pictures, width, height).find();
}

}  // namespace nutik
