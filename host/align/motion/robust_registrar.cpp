// A robust fit of all texture at once, coarse to fine: Gauss and Newton's steps on a pyramid, where what does not agree
// with the motion of most loses its weight (Tukey's biweight). The gradients are the reference's, so that they are
// taken once (Baker and Matthews, "Lucas-Kanade 20 Years On", the inverse compositional algorithm). Where the fit fails
// from the place that was guessed, matched features tell another.
#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <cstring>
#include <memory>
#include <mutex>
#include <opencv2/core.hpp>
#include <opencv2/imgproc.hpp>
#include <optional>
#include <span>
#include <tuple>
#include <type_traits>
#include <utility>
#include <vector>

#include "align/flow.hpp"
#include "align/motion/feature_start.hpp"
#include "align/motion/grey_pyramid.hpp"
#include "align/registrar.hpp"
#include "capture/error.hpp"
#include "capture/format.hpp"
#include "capture/median.hpp"
#include "system/simd_clones.hpp"

namespace nutik::motion {

std::unique_ptr<FlowFinder> open_dense_flow();  // dense_flow.cpp

namespace {

constexpr std::size_t kMinPoints = 60;
constexpr std::size_t kPoints = 20000;        // of the finest level
constexpr std::size_t kMeanPoints = 10000;    // of one whose pixels are means: found as exactly with half as many
constexpr std::size_t kLeadingPoints = 8000;  // of one that leads to a finer one
constexpr std::size_t kPointsAhead = 8;       // whose surroundings are fetched while others are looked at
constexpr double kMinSeen = 0.2;              // of the points
constexpr double kMinAcross = 0.01;           // of the texture's strength along its main direction
constexpr std::size_t kFineLevels = 3;        // that a start from close by needs
constexpr double kClearlyBetter = 2;          // of residuals
constexpr double kClearlyMost = 0.7;          // of the texture
constexpr std::size_t kMinOfPart = 8;  // places of texture: fewer tell little
constexpr double kTukey = 4.685;       // 95 % as efficient as least squares where all errors are normal
constexpr double kMinSigma = 0.3;      // codes
constexpr int kFirstSteps = 3;  // of a fit, in which nothing is excluded yet; a finer level has one of them
constexpr int kMaxSteps = 25;
constexpr double kSettledPixels = 0.002;
constexpr double kRoughlySettled = 0.05;  // pixels of a level that a finer one follows
constexpr int kHopefulSteps = 8;          // after which a fit to the finest level has to promise as much as kHopeful
constexpr double kHopeful = 0.4;          // of the texture

struct Level {
  int number = 0;     // its pixels are 2^number of the picture's
  double offset = 0;  // where the middle of its first one lies in the picture
  cv::Size size;
  std::vector<Point> points;
  [[nodiscard]] double scale() const { return std::ldexp(1.0, number); }
  // What lies within a pixel of the picture does, of large pictures within half of one of the level.
  [[nodiscard]] double agreeing() const { return number == 0 ? 1 : 0.5; }
};

using Four = float __attribute__((vector_size(16)));

// Catmull and Rom's cubic; the place lies two pixels from the border or further.
float cubic_at(const cv::Mat& grey, double x, double y) {
  const int left = static_cast<int>(x), top = static_cast<int>(y);
  const auto u = static_cast<float>(x - left), v = static_cast<float>(y - top);
  const auto between = [](auto a, auto b, auto c, auto d, float t) {
    return b + 0.5f * t * (c - a + t * (2 * a - 5 * b + 4 * c - d + t * (3 * (b - c) + d - a)));
  };
  Four rows[4];
  for (int j = 0; j < 4; ++j) std::memcpy(&rows[j], grey.ptr<float>(top + j - 1) + left - 1, sizeof rows[j]);
  const Four along = between(rows[0], rows[1], rows[2], rows[3], v);
  return between(along[0], along[1], along[2], along[3], u);
}

// Points lie too far from each other for their surroundings to be in a cache by themselves.
void fetch_ahead(const cv::Mat& grey, double x, double y) {
  const int left = static_cast<int>(x), top = static_cast<int>(y);
  for (int j = 0; j < 4; ++j) __builtin_prefetch(grey.ptr<float>(top + j - 1) + left - 1);
}

// What is fitted: the motion's numbers, in a frame that reaches to about 1 at the picture's corners; brightness last.
class Frame {
 public:
  Frame(const Shape& shape, CameraMotion motion)
      : x_((shape.width - 1) / 2.0),
        y_((shape.height - 1) / 2.0),
        radius_(std::max(1.0, std::hypot(x_, y_))),
        motion_(motion) {}

  [[nodiscard]] std::size_t count() const {
    return motion_ == CameraMotion::translation ? 2 : motion_ == CameraMotion::rigid ? 3 : 8;
  }
  [[nodiscard]] double radius() const { return radius_; }

  // How the grey at a place, in pixels of the picture, changes with each; the gradient is per `radius`.
  void slopes(double x, double y, double gx, double gy, double* slope) const {
    const double u = (x - x_) / radius_, v = (y - y_) / radius_;
    slope[0] = gx;
    slope[1] = gy;
    if (motion_ == CameraMotion::rigid) slope[2] = gy * u - gx * v;
    if (motion_ != CameraMotion::homography) return;
    const double out = gx * u + gy * v;
    slope[2] = gx * u;
    slope[3] = gx * v;
    slope[4] = gy * u;
    slope[5] = gy * v;
    slope[6] = out * u;
    slope[7] = out * v;
  }

  // The warp of these numbers, near the identity.
  [[nodiscard]] Warp warp(const double* p) const {
    Warp small;
    if (motion_ == CameraMotion::translation) {
      small.m = {1, 0, p[0], 0, 1, p[1], 0, 0, 1};
    } else if (motion_ == CameraMotion::rigid) {
      const double c = std::cos(p[2]), s = std::sin(p[2]);
      small.m = {c, -s, p[0], s, c, p[1], 0, 0, 1};
    } else {
      small.m = {1 + p[2], p[3], p[0], p[4], 1 + p[5], p[1], -p[6], -p[7], 1};
    }
    const Warp into{{1 / radius_, 0, -x_ / radius_, 0, 1 / radius_, -y_ / radius_, 0, 0, 1}};
    const Warp back{{radius_, 0, x_, 0, radius_, y_, 0, 0, 1}};
    return chained(chained(into, small), back);
  }

 private:
  double x_, y_, radius_;
  CameraMotion motion_;
};

// Brightness of a picture by the reference's: gain * grey + offset.
struct Fit {
  Warp warp;
  double gain = 1, offset = 0;
};

// As many as fill vectors: those beyond the numbers that are fitted are zero.
using Row = std::array<double, 12>;

NUTIK_SIMD_CLONES void add_squares(const Row& slopes, double weight, double value, std::size_t numbers,
                                   Row* __restrict squares, Row& __restrict values) {
  for (std::size_t i = 0; i < numbers; ++i) {
    double* const row = squares[i].data();
    const double weighed = weight * slopes.data()[i];
    for (std::size_t k = 0; k < std::tuple_size_v<Row>; ++k) row[k] += weighed * slopes.data()[k];
    values.data()[i] += weighed * value;
  }
}

// Weighted least squares of a few numbers: what is added up for them, and their solution.
class NormalEquations {
 public:
  static constexpr std::size_t kMaxNumbers = 10;

  explicit NormalEquations(std::size_t numbers) : numbers_(numbers) {}

  // That the numbers, each times the slope of the same place, add up to `value`.
  void add(const Row& slopes, double weight, double value) {
    add_squares(slopes, weight, value, numbers_, squares_.data(), values_);
  }

  // False where nothing tells some of the numbers.
  [[nodiscard]] bool solve(std::span<double> numbers) {
    const auto count = static_cast<int>(numbers_);
    const cv::Mat squares(count, count, CV_64F, squares_.data(), sizeof(Row)), values(count, 1, CV_64F, values_.data());
    return cv::solve(squares, values, cv::Mat(count, 1, CV_64F, numbers.data()), cv::DECOMP_CHOLESKY);
  }

 private:
  std::size_t numbers_;
  std::array<Row, kMaxNumbers> squares_{};
  Row values_{};
};

struct Sampled {
  const Point* point;
  double x, y;    // of the picture
  double px, py;  // where the warp says, of the level
  double grey;    // of the picture that is registered, there
};

using Parts = std::array<std::vector<double>, kPartsToASide * kPartsToASide>;

class RobustRegistrar final : public Registrar {
 public:
  RobustRegistrar(const CaptureFormat& format, std::span<const std::byte> reference) : format_(format) {
    GreyPyramid pyramid;
    pyramid.take(format, reference);
    for (std::size_t i = 0; i < pyramid.levels.size(); ++i) {
      const cv::Mat& grey = pyramid.levels[i];
      Level level{pyramid.finest + static_cast<int>(i), (std::ldexp(1.0, pyramid.finest) - 1) / 2, grey.size(),
                  textured_points(grey, i > 0 ? kLeadingPoints : pyramid.finest > 0 ? kMeanPoints : kPoints)};
      if (i > 0 && level.points.size() < kMinPoints) break;
      if (i == 0) check_texture(level.points);
      levels_.push_back(std::move(level));
    }
    reference_ = pyramid.of_features();
    const Level& finest = levels_.front();
    halves_.fill({finest.number, finest.offset, finest.size, {}});
    for (const Point& point : finest.points) {
      const std::size_t part = part_of(finest, point);
      halves_[(part + part / kPartsToASide) % 2].points.push_back(point);
    }
  }

  Registered find(std::span<const std::byte> raster, CameraMotion motion, const Warp& guess, Reach reach) override {
    return with_pyramid(raster, [&](const GreyPyramid& pyramid) { return found_in(pyramid, guess, reach, motion); });
  }

  Compared compare(std::span<const std::byte> raster, const std::array<CameraMotion, 2>& motions,
                   const std::array<Warp, 2>& guesses) override {
    return with_pyramid(raster, [&](const GreyPyramid& pyramid) {
      Compared compared;
      for (std::size_t i = 0; i < 2; ++i)
        compared.found[i] = found_in(pyramid, guesses[i], Reach::anywhere, motions[i]);
      if (is_sure(compared.found[0]) && is_sure(compared.found[1]))
        compared.better = better_parts(pyramid.levels.front(), motions, compared.found);
      return compared;
    });
  }

  [[nodiscard]] bool sees_much() const override {
    std::array<std::size_t, std::tuple_size_v<Parts>> counts{};
    for (const Point& point : levels_.front().points) ++counts[part_of(levels_.front(), point)];
    const auto textured = std::ranges::count_if(counts, [](std::size_t count) { return count >= kMinOfPart; });
    return 4 * static_cast<std::size_t>(textured) >= counts.size();
  }

 private:
  [[nodiscard]] static std::size_t part_of(const Level& level, const Point& point) {
    const auto part = [](auto at, int size) {
      return static_cast<std::size_t>(at) * kPartsToASide / static_cast<std::size_t>(size);
    };
    return part(point.y, level.size.height) * kPartsToASide + part(point.x, level.size.width);
  }

  // As many pyramids come to be as searches run at the same time.
  template <typename Search>
  [[nodiscard]] std::invoke_result_t<Search, const GreyPyramid&> with_pyramid(std::span<const std::byte> raster,
                                                                              const Search& search) {
    std::unique_ptr<GreyPyramid> pyramid;
    {
      const std::scoped_lock lock(pyramids_mutex_);
      if (!pyramids_.empty()) {
        pyramid = std::move(pyramids_.back());
        pyramids_.pop_back();
      }
    }
    if (!pyramid) pyramid = std::make_unique<GreyPyramid>();
    pyramid->take(format_, raster);
    auto found = search(*pyramid);
    const std::scoped_lock lock(pyramids_mutex_);
    pyramids_.push_back(std::move(pyramid));
    return found;
  }

  [[nodiscard]] Registered found_in(const GreyPyramid& pyramid, const Warp& guess, Reach reach,
                                    CameraMotion motion) {
    const Frame frame(format_.shape, motion), coarse(format_.shape, coarse_motion(motion));
    Registered best = best_of(pyramid, guess, reach, frame, coarse);
    if (reach == Reach::near) return unless_it_rests(pyramid.levels.front(), guess, best);
    if (best.agreeing >= kClearlyMost || frame.count() == coarse.count()) return best;
    // Eight numbers may follow what moves from where three are led to what rests.
    const Registered simpler = best_of(pyramid, guess, reach, coarse, coarse);
    if (simpler.agreeing <= best.agreeing) return best;
    std::vector<Entry> entries;
    return more_agreeing(simpler, fit(pyramid, simpler.warp, 1, frame, coarse, entries));
  }

  // In which parts the second of two motions predicts better than the first what the picture shows, where each is
  // fitted to the other half of the parts: following noise gains nothing there.
  [[nodiscard]] BetterParts better_parts(const cv::Mat& grey, std::span<const CameraMotion> motions,
                                         std::span<const Registered> found) const {
    BetterParts better{};
    for (std::size_t half = 0; half < halves_.size(); ++half) {
      std::array<Parts, 2> missed;
      for (std::size_t i = 0; i < missed.size(); ++i) {
        Fit fit{found[i].warp, 1, 0};
        if (!settle(halves_[half], grey, Frame(format_.shape, motions[i]), 1, kSettledPixels, fit)) return {};
        for (const Sampled& sample : sampled(halves_[1 - half], grey, fit.warp))
          missed[i][part_of(levels_.front(), *sample.point)].push_back(std::abs(residual(sample, fit)));
      }
      for (std::size_t part = 0; part < better.size(); ++part) {
        if (std::min(missed[0][part].size(), missed[1][part].size()) < kMinOfPart) continue;
        const double first = median(missed[0][part]), second = median(missed[1][part]);
        better[part] = static_cast<std::int8_t>((second < first) - (second > first));
      }
    }
    return better;
  }

  [[nodiscard]] Registered best_of(const GreyPyramid& pyramid, const Warp& guess, Reach reach, const Frame& fine,
                                   const Frame& coarse) {
    std::vector<Entry> entries;
    Registered best = fit(pyramid, guess, levels_.size(), fine, coarse, entries);
    // Fine texture is seen on no coarser level, where what moves may be all there is.
    for (const std::size_t levels : {kFineLevels, std::size_t{1}}) {
      if (!is_sure(best)) best = more_agreeing(best, fit(pyramid, guess, levels, fine, coarse, entries));
    }
    if (is_sure(best) || reach == Reach::near) return best;
    const std::scoped_lock lock(features_mutex_);
    if (!features_) features_.emplace(reference_, pyramid.feature_scale());
    const auto start = features_->find(pyramid.of_features());
    return start ? more_agreeing(best, fit(pyramid, *start, kFineLevels, fine, coarse, entries)) : best;
  }

  static const Registered& more_agreeing(const Registered& first, const Registered& second) {
    return second.agreeing > first.agreeing ? second : first;
  }

  // Away from the finest levels there is too little to tell a homography from.
  static CameraMotion coarse_motion(CameraMotion motion) {
    return motion == CameraMotion::homography ? CameraMotion::rigid : motion;
  }

  static void check_texture(const std::vector<Point>& points) {
    if (points.size() < kMinPoints) {
      throw TooLittleTexture(
          format("it has {} pixels whose surroundings can be recognized, and {} are needed", points.size(),
                 kMinPoints));
    }
    double xx = 0, xy = 0, yy = 0;
    for (const Point& point : points) {
      xx += point.gradient_x * point.gradient_x;
      xy += point.gradient_x * point.gradient_y;
      yy += point.gradient_y * point.gradient_y;
    }
    const double middle = (xx + yy) / 2, spread = std::hypot((xx - yy) / 2, xy);
    if (middle - spread < kMinAcross * (middle + spread)) {
      throw TooLittleTexture(
          "all its edges run in one direction, along which nothing tells where a picture lies");
    }
  }

  // By how many pixels two warps differ at the picture's corners.
  [[nodiscard]] double apart(const Warp& a, const Warp& b) const {
    const double right = format_.shape.width - 1.0, bottom = format_.shape.height - 1.0;
    double most = 0;
    for (const Place& corner : {Place{0, 0}, {right, 0}, {0, bottom}, {right, bottom}}) {
      const Place one = a.at(corner.x, corner.y), other = b.at(corner.x, corner.y);
      most = std::max(most, std::hypot(one.x - other.x, one.y - other.y));
    }
    return most;
  }

  // From where a fit came to a level, led by a coarser one.
  struct Entry {
    std::size_t level;
    Warp warp;
  };

  // Where an earlier fit came from the same place, this one would go the same way: nothing agrees then.
  [[nodiscard]] Registered fit(const GreyPyramid& pyramid, const Warp& guess, std::size_t levels, const Frame& fine,
                               const Frame& coarse, std::vector<Entry>& entries) const {
    Fit fit{guess, 1, 0};
    bool is_first = true;
    for (std::size_t i = std::min(levels, levels_.size()); i-- > 0;) {
      if (!is_first) {
        const double alike = kRoughlySettled * levels_[i + 1].scale();
        for (const Entry& entry : entries) {
          if (entry.level == i && apart(entry.warp, fit.warp) <= alike) return {guess, 0, 0};
        }
        entries.push_back({i, fit.warp});
      }
      const bool is_fine =
          i == 0 || (i == 1 && levels_[i].size.height >= 100 && levels_[i].size.width >= 100);
      Fit settled = fit;
      const double enough = i == 0 ? kSettledPixels : kRoughlySettled * levels_[i].scale();
      if (settle(levels_[i], pyramid.levels[i], is_fine ? fine : coarse, is_first ? kFirstSteps : 1,
                 enough, settled)) {
        fit = settled;
        is_first = false;
      } else if (i == 0) {
        return {guess, 0, 0};
      }
    }
    return judged(levels_.front(), pyramid.levels.front(), fit);
  }

  // Near by, most pictures lie just where they are expected: that stands unless another place is clearly better, by
  // texture from much of the picture. A thing that moves over a bare wall is no camera's motion.
  [[nodiscard]] Registered unless_it_rests(const cv::Mat& grey, const Warp& guess,
                                           const Registered& best) const {
    const Level& level = levels_.front();
    const std::vector<Sampled> seen = sampled(level, grey, guess);
    if (seen.empty()) return best;
    const Registered rests = judged(level, grey, {guess, 1, brighter_by(seen)});
    if (rests.residual_pixels <= kClearlyBetter * best.residual_pixels) return rests;
    if (!is_sure(best) || !is_spread(level, grey, guess, best.warp)) return {guess, 0, rests.residual_pixels};
    return best.agreeing >= kClearlyMost ? best : Registered{best.warp, 0, rests.residual_pixels};
  }

  // Whether a quarter of the picture's parts or more follow a warp, and clearly not what is expected: noise over a dark
  // wall is as near to any place.
  [[nodiscard]] static bool is_spread(const Level& level, const cv::Mat& grey, const Warp& guess,
                                      const Warp& warp) {
    Parts expected = parts_of(level, grey, guess), followed = parts_of(level, grey, warp);
    std::size_t parts = 0;
    for (std::size_t i = 0; i < followed.size(); ++i) {
      if (std::min(expected[i].size(), followed[i].size()) < kMinOfPart) continue;
      const double away = median(followed[i]);
      parts += away <= level.agreeing() && median(expected[i]) > kClearlyBetter * away ? 1 : 0;
    }
    return 4 * parts >= followed.size();
  }

  // How far texture lies from where a warp says, in pixels of the level, for each part of the picture.
  [[nodiscard]] static Parts parts_of(const Level& level, const cv::Mat& grey, const Warp& warp) {
    Parts parts;
    const std::vector<Sampled> seen = sampled(level, grey, warp);
    if (seen.empty()) return parts;
    const Fit fit{warp, 1, brighter_by(seen)};
    for (const Sampled& sample : seen) {
      parts[part_of(level, *sample.point)].push_back(std::abs(residual(sample, fit)) / gradient_of(*sample.point));
    }
    return parts;
  }

  // The points that the picture shows, too. Empty where these are few.
  [[nodiscard]] static std::vector<Sampled> sampled(const Level& level, const cv::Mat& grey,
                                                    const Warp& warp) {
    std::vector<Sampled> seen;
    seen.reserve(level.points.size());
    const double scale = level.scale();
    for (const Point& point : level.points) {
      const double x = scale * point.x + level.offset, y = scale * point.y + level.offset;
      const Place there = warp.at(x, y);
      const double px = (there.x - level.offset) / scale, py = (there.y - level.offset) / scale;
      if (!(px >= 2 && py >= 2 && px < grey.cols - 3 && py < grey.rows - 3)) continue;
      seen.push_back({&point, x, y, px, py, 0});
    }
    if (static_cast<double>(seen.size()) < kMinSeen * static_cast<double>(level.points.size())) seen.clear();
    for (std::size_t i = 0; i < seen.size(); ++i) {
      if (i + kPointsAhead < seen.size())
        fetch_ahead(grey, seen[i + kPointsAhead].px, seen[i + kPointsAhead].py);
      seen[i].grey = double{cubic_at(grey, seen[i].px, seen[i].py)};
    }
    return seen;
  }

  [[nodiscard]] static double residual(const Sampled& sample, const Fit& fit) {
    return sample.grey - fit.gain * sample.point->grey - fit.offset;
  }

  // How much brighter most of them are than the reference.
  [[nodiscard]] static double brighter_by(const std::vector<Sampled>& seen) {
    std::vector<double> brighter;
    for (const Sampled& sample : seen) brighter.push_back(sample.grey - sample.point->grey);
    return median(brighter);
  }

  // Whether enough of the texture may agree after some more steps. Each gains less than the one before it.
  [[nodiscard]] static bool is_hopeful(std::span<const double> shares, int steps) {
    const double last = shares.back(), gain = (last - shares[shares.size() - 3]) / 2;
    return last + steps * std::max(gain, 0.0) >= kHopeful;
  }

  // Until a step moves the corners by no more than `enough` pixels of the picture, or hope is gone. False where the
  // picture shows too little of the reference, or the fit leads nowhere.
  bool settle(const Level& level, const cv::Mat& grey, const Frame& frame, int first_steps, double enough,
              Fit& fit) const {
    const std::size_t motion = frame.count(), count = motion + 2;  // brightness has two numbers
    const double per_radius = frame.radius() / level.scale();
    std::vector<double> sizes, shares;
    for (int step = 0; step < kMaxSteps; ++step) {
      const std::vector<Sampled> seen = sampled(level, grey, fit.warp);
      if (seen.empty()) return false;
      sizes.clear();
      for (const Sampled& sample : seen) sizes.push_back(std::abs(residual(sample, fit)));
      if (&level == &levels_.front() && step >= kHopefulSteps - 2) {
        shares.push_back(agreeing(level, away_from(seen, fit)));
        if (step >= kHopefulSteps && !is_hopeful(shares, kMaxSteps - 1 - step)) break;
      }
      const double limit = kTukey * std::max(kMinSigma, 1.4826 * median(sizes));
      NormalEquations equations(count);
      Row slopes{};
      for (const Sampled& sample : seen) {
        const double share = residual(sample, fit) / limit;
        double weight = 1 / (1 + 9 * share * share);  // Cauchy's, which excludes nothing
        if (step >= first_steps) {
          if (std::abs(share) >= 1) continue;
          weight = (1 - share * share) * (1 - share * share);
        }
        const Point& point = *sample.point;
        frame.slopes(sample.x, sample.y, per_radius * point.gradient_x, per_radius * point.gradient_y,
                     slopes.data());
        slopes[motion] = point.grey / kGreyWhite;
        slopes[motion + 1] = 1;
        equations.add(slopes, weight, sample.grey);
      }
      std::array<double, NormalEquations::kMaxNumbers> numbers;
      if (!equations.solve(numbers)) return false;
      fit.gain = numbers[motion] / kGreyWhite;
      fit.offset = numbers[motion + 1];
      if (!(fit.gain > 0.2 && fit.gain < 5)) return false;
      double square = 0;
      for (std::size_t i = 0; i < motion; ++i) {
        numbers[i] /= fit.gain;
        square += numbers[i] * numbers[i];
      }
      const double moved = std::sqrt(square) * frame.radius();
      if (!(moved < frame.radius())) return false;
      fit.warp = chained(inverse(frame.warp(numbers.data())), fit.warp);
      if (moved < enough && step > first_steps) break;
    }
    return true;
  }

  // How far each lies from where a fit says, in pixels of the level.
  [[nodiscard]] static std::vector<double> away_from(const std::vector<Sampled>& seen, const Fit& fit) {
    std::vector<double> away;
    for (const Sampled& sample : seen)
      away.push_back(std::abs(residual(sample, fit)) / (fit.gain * gradient_of(*sample.point)));
    return away;
  }

  [[nodiscard]] static double agreeing(const Level& level, std::span<const double> away) {
    const auto agree = std::ranges::count_if(away, [&](double each) { return each <= level.agreeing(); });
    return static_cast<double>(agree) / static_cast<double>(away.size());
  }

  [[nodiscard]] static Registered judged(const Level& level, const cv::Mat& grey, const Fit& fit) {
    const std::vector<Sampled> seen = sampled(level, grey, fit.warp);
    if (seen.empty()) return {fit.warp, 0, 0};
    std::vector<double> away = away_from(seen, fit);
    const double share = agreeing(level, away);
    return {fit.warp, share, level.scale() * median(away)};
  }

  CaptureFormat format_;
  std::vector<Level> levels_;    // the finest first
  std::array<Level, 2> halves_;  // that one, in every second of the picture's parts
  cv::Mat reference_;          // for features, which are looked for when they are first needed
  std::optional<FeatureStart> features_;
  std::mutex features_mutex_;
  std::vector<std::unique_ptr<GreyPyramid>> pyramids_;  // that no search uses now
  std::mutex pyramids_mutex_;
};

std::unique_ptr<Registrar> open_robust_registrar(const CaptureFormat& format, std::span<const std::byte> reference) {
  return std::make_unique<RobustRegistrar>(format, reference);
}

// In nutik-cl, which does one work, OpenCV's threads would gain nothing beside its own, and oneTBB hangs where it finds
// no memory to start them. In Python they are another's.
void begin(SharedState& of_program) {
  use_shared_state(of_program);
  if (of_program.is_one_work) cv::setNumThreads(0);
}

}  // namespace
}  // namespace nutik::motion

extern "C" __attribute__((visibility("default"))) const nutik::MotionModule nutik_motion_module{
    nutik::motion::begin, nutik::motion::open_robust_registrar, nutik::motion::open_dense_flow};

extern "C" __attribute__((visibility("default"))) const char nutik_module_version[] = NUTIK_VERSION;
