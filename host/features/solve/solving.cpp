#include "features/solve/solving.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include "capture/error.hpp"
#include "capture/format.hpp"
#include "capture/source_text.hpp"
#include "features/plate/plate.hpp"
#include "features/solve/wish.hpp"
#include "imev/each_block.hpp"
#include "render/code_scale.hpp"
#include "session/requests/named_inputs.hpp"
#include "session/text/number_text.hpp"
#include "solve/time_search.hpp"
#include "system/input_bytes.hpp"

namespace nutik {
namespace {

// A larger share of a region's light at the white code is warned of.
constexpr double kMaxWhite = 0.01;
// What the exposure comes to lies no further from what was reckoned, unless it is computed in single.
constexpr double kMaxApart = 1e-6;

class Solver {
 public:
  Solver(Session& session, const std::string& capture_name, const SolveRequest& request)
      : session_(session),
        name_(capture_name),
        request_(request),
        timeline_(session.timeline()),
        mask_(mask_of(request.exposure, session.format().shape)) {}

  SolvedExposure solve(const ReportedProgress& reading, const ReportedProgress& searching) {
    check();
    const std::vector<CandidateTimes> candidates =
        candidate_times(request_.functions, request_.free, timeline_);
    WishedExposure wished = measure(candidates, reading);
    const std::vector<double> white = white_shares(wished);
    GainSearch search(std::move(wished));
    auto found = find_times(search, candidates, searching);
    if (!found) {
      throw UsageError(
          "there are no times for which the control points of every function are in order: narrow the ranges "
          "of times");
    }
    SolvedExposure solved;
    solved.numbers = {found->found.gains, found->times_ns};
    solved.tried = found->tried;
    solved.moved = moved_;
    solved.untold = search.untold();
    solved.open_count = search.open_count();
    solved.text = request_.functions.text_with(solved.numbers);
    solved.at_ends = names_at_ends(solved.numbers, candidates);
    expose(search, solved);
    warn_of_white(white, solved);
    warn_of_nothing(solved);
    return solved;
  }

 private:
  // What can be told before the capture is read.
  void check() const {
    const Shape& shape = session_.format().shape;
    if (request_.wishes.empty()) throw UsageError("nothing is wished for");
    // Masks and functions that do not fit.
    static_cast<void>(make_plan(session_.capture(), tags_of(request_.functions), mask_,
                                plan_options_of(request_.exposure, session_.format().shape)));
    if (request_.marks) {
      const Mask& marks = **request_.marks;
      if (marks.width != shape.width || marks.height != shape.height) {
        throw InputError(format("the mask of regions is {} x {}, the capture {} x {}", marks.width,
                                marks.height, shape.width, shape.height));
      }
    }
    const bool is_light_restated =
        request_.exposure.plan.transfer &&
        Transfer::restated(session_.format().transfer, *request_.exposure.plan.transfer) != session_.format().transfer;
    for (const StatedWish& wish : request_.wishes) {
      const auto fail = [&](const char* why) {
        throw UsageError(format("the wish {}: {}", nutik::quoted(wish.text), why));
      };
      if (wish.has_tag() && !request_.exposure.mask)
        fail("M and a number is a value of the mask, and there is none");
      if (wish.has_mark() && !request_.marks)
        fail("R and a number is a value of a second mask, and there is none");
      check(wish.region, wish);
      if (const auto* other = std::get_if<LightRegion>(&wish.target)) check(*other, wish);
      if (wish.needs_plate() && is_light_restated) {
        throw UsageError(
            format("the wish {}: the background is found with the capture's own transfer function; correct that in "
                   "the capture (retime), or name a time in place of the background",
                   nutik::quoted(wish.text)));
      }
    }
  }

  // Checks what all that follows takes, so that nothing is begun that cannot be ended.
  void check_memory(SampleRange samples) const {
    tik::Reader& capture = session_.capture();
    std::uint32_t block_samples = 0;
    for (std::uint64_t block = 0; block < capture.block_count(); ++block)
      block_samples = std::max(block_samples, capture.block_extent(block).sample_count);
    MemoryNeeds needs = rendering_needs(session_.format(), ValueType::light64,
                                        request_.functions.functions.size(), block_samples);
    needs.add(solve_needs(request_)(session_.format()));
    needs.add("a block", largest_block(capture));
    needs.add(region_light_needs(capture, mask_, marks(), regions_, samples));
    needs.rest_of(session_.devices().request().memory.bytes);
  }

  void check(const LightRegion& region, const StatedWish& wish) const {
    const Shape& shape = session_.format().shape;
    const auto fail = [&](const std::string& why) {
      throw UsageError(format("the wish {}: {}", nutik::quoted(wish.text), why));
    };
    if (region.within && !region.within->lies_in(shape)) {
      const Rectangle& at = *region.within;
      fail(format("the rectangle {},{},{},{} does not lie in the picture, which has {} x {} pixels", at.x,
                  at.y, at.width, at.height, shape.width, shape.height));
    }
    const RegionPixels pixels(mask_, request_.marks ? &**request_.marks : nullptr);
    for (std::uint64_t pixel = 0; pixel < shape.pixel_count(); ++pixel) {
      if (pixels.weight(region, pixel) > 0.0) return;
    }
    fail("no pixel is in its region");
  }

  // Everything that a candidate may expose, and the moments that wishes name.
  [[nodiscard]] SampleRange needed_samples(const std::vector<CandidateTimes>& candidates) const {
    std::int64_t begin_ns = timeline_.duration_ns(), end_ns = 0;
    const auto add = [&](std::int64_t from_ns, std::int64_t to_ns) {
      begin_ns = std::min(begin_ns, std::clamp<std::int64_t>(from_ns, 0, timeline_.duration_ns()));
      end_ns = std::max(end_ns, std::clamp<std::int64_t>(to_ns, 0, timeline_.duration_ns()));
    };
    for (const auto& [tag, points] : request_.functions.functions) {
      const auto is_zero = [](const TemplatePoint& point) { return !point.gain_name && point.gain == 0.0; };
      for (const TemplatePoint& point : points) {
        const auto* named = point.time_name ? &candidates[*point.time_name].times_ns : nullptr;
        add(point.time_ns + (named != nullptr ? named->front() : 0),
            point.time_ns + (named != nullptr ? named->back() : 0));
      }
      if (!is_zero(points.front())) add(0, 0);
      if (!is_zero(points.back())) add(timeline_.duration_ns(), timeline_.duration_ns());
    }
    for (const StatedWish& wish : request_.wishes) {
      if (const auto* moment = std::get_if<StatedWish::Moment>(&wish.target)) {
        const Exposure interval = interval_of(*moment);
        add(interval.start_ns, interval.end_ns);
      }
    }
    SampleRange samples = timeline_.samples_reaching(begin_ns, std::max(end_ns, begin_ns + 1));
    // Across gaps light goes on to the samples beside them.
    samples.first -= samples.first > 0 ? 1 : 0;
    samples.last = std::min(samples.last + 1, timeline_.sample_count());
    return samples;
  }

  [[nodiscard]] Exposure interval_of(const StatedWish::Moment& moment) const {
    if (!moment.to) {
      const Timeline& pictures = timeline_.pictures();
      const std::uint64_t picture = sample_at(moment.from, "the time", pictures);
      return {pictures.start_ns(picture), pictures.end_ns(picture)};
    }
    const Exposure interval{moment_ns(moment.from, timeline_), moment_ns(*moment.to, timeline_)};
    if (interval.start_ns < 0 || interval.end_ns > timeline_.duration_ns() ||
        interval.start_ns >= interval.end_ns) {
      throw UsageError(format("{}..{} is no interval of the capture, which lasts {}", moment.from.text(),
                              moment.to->text(), duration_text(timeline_.duration_ns())));
    }
    return interval;
  }

  WishedExposure measure(const std::vector<CandidateTimes>& candidates, const ReportedProgress& reading) {
    const CaptureFormat& format = session_.format();
    WishedExposure wished;
    wished.duration_ns = timeline_.duration_ns();
    wished.functions = request_.functions.functions;
    wished.normalization = request_.exposure.normalization;
    wished.gain = request_.exposure.gain;
    wished.channels = format.shape.channels;
    const ColourMatrix& to_screen = to_bt709(format.primaries);
    for (std::size_t channel = 0; channel < wished.channels; ++channel) {
      for (std::size_t row = 0; row < 3; ++row)
        wished.luminance[channel] += wished.channels == 1 ? kLuma[row] : kLuma[row] * to_screen[row][channel];
    }
    wished.bounds.resize(request_.functions.gains.size());
    for (const StatedFreedom& free : request_.free) {
      if (const auto* bounds = std::get_if<Bounds>(&free.range)) {
        const auto found = std::ranges::find(request_.functions.gains, free.name);
        wished.bounds[static_cast<std::size_t>(found - request_.functions.gains.begin())] = *bounds;
      }
    }
    for (const StatedWish& wish : request_.wishes) {
      LightWish light;
      light.region = region_number(wish.region);
      if (const auto* other = std::get_if<LightRegion>(&wish.target)) light.target = region_number(*other);
      if (const auto* number = std::get_if<double>(&wish.target)) light.target = *number;
      light.kind = wish.kind;
      light.factor = wish.factor;
      light.weight = wish.weight;
      wished.wishes.push_back(std::move(light));
    }

    const SampleRange samples = needed_samples(candidates);
    check_memory(samples);
    std::optional<Picture> plate;
    if (request_.needs_plate()) {
      moved_ = moved_camera(session_.capture());
      OutputFormat light;
      light.type = ValueType::light64;
      plate = make_plate(session_.capture(), name_, {}, light, session_.devices().request().memory, reading)
                  .picture;
    }
    wished.regions = measure_regions(session_.capture(), request_.exposure.plan.transfer.value_or(format.transfer),
                                     mask_, marks(), regions_, plate ? &*plate : nullptr, samples, reading);
    for (std::size_t i = 0; i < wished.wishes.size(); ++i) {
      set_rest(request_.wishes[i], wished.regions[wished.wishes[i].region], wished.wishes[i]);
    }
    // Functions that expose nothing of any region tell nothing.
    std::erase_if(wished.functions, [&](const auto& entry) {
      return std::ranges::none_of(
          wished.regions, [&](const RegionLight& region) { return region.courses.contains(entry.first); });
    });
    for (LightWish& wish : wished.wishes)
      std::erase_if(wish.still, [&](const auto& entry) { return !wished.functions.contains(entry.first); });
    return wished;
  }

  // The light of a plate or of a moment.
  void set_rest(const StatedWish& wish, const RegionLight& region, LightWish& light) const {
    std::map<std::uint8_t, ChannelLight> still;
    if (wish.needs_plate()) {
      still = region.plate;
    } else if (const auto* moment = std::get_if<StatedWish::Moment>(&wish.target)) {
      const Exposure interval = interval_of(*moment);
      const GainPiece piece{interval.start_ns, interval.end_ns, 1.0, 1.0};
      for (const auto& [tag, course] : region.courses) {
        ChannelLight mean = course.integral_ns({&piece, 1});
        for (double& each : mean) each /= static_cast<double>(interval.end_ns - interval.start_ns);
        still.emplace(tag, mean);
      }
    } else {
      return;
    }
    ChannelLight whole{};
    for (const auto& [tag, part] : still) {
      for (std::size_t channel = 0; channel < whole.size(); ++channel) whole[channel] += part[channel];
    }
    light.target = whole;
    if (wish.kind == LightWish::Kind::gone) light.still = std::move(still);
  }

  std::size_t region_number(const LightRegion& region) {
    const auto found = std::ranges::find(regions_, region);
    const auto number = static_cast<std::size_t>(found - regions_.begin());
    if (found == regions_.end()) regions_.push_back(region);
    return number;
  }

  [[nodiscard]] std::vector<std::string> names_at_ends(const NamedNumbers& numbers,
                                                       const std::vector<CandidateTimes>& candidates) const {
    const FunctionTemplate& functions = request_.functions;
    std::vector<std::string> names;
    for (const StatedFreedom& free : request_.free) {
      const auto* const bounds = std::get_if<Bounds>(&free.range);
      const auto gain = std::ranges::find(functions.gains, free.name);
      if (bounds == nullptr || gain == functions.gains.end()) continue;
      const double found = numbers.gains[static_cast<std::size_t>(gain - functions.gains.begin())];
      if (found <= bounds->low + kLeastGain || found >= bounds->high - kLeastGain) names.push_back(free.name);
    }
    for (std::size_t i = 0; i < candidates.size(); ++i) {
      const std::int64_t found_ns = numbers.times_ns[i];
      if (found_ns <= candidates[i].times_ns.front() || found_ns >= candidates[i].times_ns.back())
        names.push_back(functions.times[i]);
    }
    return names;
  }

  // The exposure that a person makes with what was found, and what wishes got.
  void expose(const GainSearch& search, SolvedExposure& solved) {
    ExposureRequest request = request_.exposure;
    request.gains = read_functions(solved.text, "the functions that were found").functions;
    OutputFormat light;
    light.type = ValueType::light64;
    ExposedPicture exposed = session_.render(request, light);
    const RegionPixels pixels(mask_, marks());
    std::vector<ChannelLight> region_light;
    for (const LightRegion& region : regions_)
      region_light.push_back(mean_light(exposed.picture, pixels, region));
    const std::vector<ChannelLight> reckoned = search.region_light();
    double apart = 0.0;
    for (std::size_t i = 0; i < reckoned.size(); ++i) {
      for (std::size_t channel = 0; channel < 3; ++channel)
        apart = std::max(apart, std::fabs(reckoned[i][channel] - region_light[i][channel]));
    }
    solved.warnings = std::move(exposed.warnings);
    if (apart > kMaxApart) {
      solved.warnings.push_back(
          format("the exposure is {:.2g} of white from what the numbers were found with, which is computed "
                 "in double",
                 apart));
    }
    const std::vector<WishedLight> wished = search.wished(region_light);
    for (std::size_t i = 0; i < wished.size(); ++i) {
      const LightWish& wish = search.exposure().wishes[i];
      SolvedWish& each = solved.wishes.emplace_back();
      each.text = request_.wishes[i].text;
      each.light = wished[i];
      each.missed = search.missed(wish, wished[i]);
      for (const double missed : each.missed) each.cost += wish.weight * missed * missed;
    }
    OutputFormat codes;
    codes.transfer = Transfer::srgb();
    static_cast<void>(stored(std::move(exposed.picture), session_.format(), codes, solved.saturation));
  }

  static std::vector<double> white_shares(const WishedExposure& wished) {
    std::vector<double> shares;
    for (const LightWish& wish : wished.wishes) shares.push_back(wished.regions[wish.region].white_share);
    return shares;
  }

  void warn_of_white(const std::vector<double>& shares, SolvedExposure& solved) const {
    for (std::size_t i = 0; i < shares.size(); ++i) {
      if (shares[i] <= kMaxWhite) continue;
      solved.warnings.push_back(
          format("the wish {}: {:.2g} % of its region's light is held at the white code, where the "
                 "scene may have been brighter than the capture tells",
                 nutik::quoted(request_.wishes[i].text), 100 * shares[i]));
    }
  }

  // A wish for nothing is kept best by a picture of nothing.
  void warn_of_nothing(SolvedExposure& solved) const {
    const std::uint64_t pixels = session_.format().shape.pixel_count();
    const auto [below, above] = solved.saturation;
    if (2 * below <= pixels && 2 * above <= pixels) return;
    const bool is_black = below >= above;
    solved.warnings.push_back(
        format("{} of the picture's {} pixels come out {}: bound the gains, or wish for what is to stay, too (all = "
               "background)",
               is_black ? below : above, pixels, is_black ? "below 0, which is black" : "above 1, which is white"));
  }

  [[nodiscard]] const Mask* marks() const { return request_.marks ? &**request_.marks : nullptr; }

  Session& session_;
  const std::string& name_;
  const SolveRequest& request_;
  const Timeline& timeline_;
  Mask mask_;
  std::vector<LightRegion> regions_;
  std::optional<MovedCamera> moved_;  // where a plate is asked for
};

}  // namespace

TemplateInput read_template_input(const std::string& name) {
  return read_template(InputBytes(name).text(), input_title(name));
}

TemplateInput read_template(std::string_view text, const std::string& title) {
  TemplateInput input{parse_template(text), {}};
  const std::string report = input.functions.diagnostics.report(title);
  if (input.functions.has_errors()) throw InputError(format("{} has mistakes:\n{}", title, report));
  if (input.functions.gains.empty() && input.functions.times.empty()) {
    throw UsageError(
        format("{} leaves nothing to be found: write a name in place of a gain or a time, as in "
               "M0 [0:1], [10000000:rest], …",
               title));
  }
  input.warnings = report;
  return input;
}

bool SolveRequest::needs_plate() const { return std::ranges::any_of(wishes, &StatedWish::needs_plate); }

bool SolvedWish::is_kept() const {
  constexpr double kHalfCode = 0.5 / 255;
  const Transfer screen = Transfer::srgb();
  for (std::size_t i = 0; i < missed.size(); ++i) {
    const double wanted = light.wanted[i];
    if (std::fabs(screen.fraction_of(wanted + missed[i]) - screen.fraction_of(wanted)) > kHalfCode)
      return false;
  }
  return true;
}

bool SolvedExposure::is_kept() const { return std::ranges::all_of(wishes, &SolvedWish::is_kept); }

double SolvedExposure::cost() const {
  double cost = 0.0;
  for (const SolvedWish& wish : wishes) cost += wish.cost;
  return cost;
}

FunctionSet tags_of(const FunctionTemplate& functions) {
  FunctionSet tags;
  for (const auto& [tag, points] : functions.functions) tags.emplace(tag, GainFunction({{0, 1.0}}));
  return tags;
}

NeedsOfFormat solve_needs(const SolveRequest& request) {
  const bool needs_plate = request.needs_plate();
  return [needs_plate](const CaptureFormat& capture) {
    MemoryNeeds needs{{"masks of regions", 2 * capture.shape.pixel_count()},
                      {"codes of the picture", capture.shape.value_count()}};
    if (needs_plate) {
      needs.add(plate_making_needs(capture));
      needs.add(camera_check_needs(capture));
    }
    return needs;
  };
}

SolvedExposure solve(Session& session, const std::string& capture_name, const SolveRequest& request,
                     const ReportedProgress& reading, const ReportedProgress& searching) {
  return Solver(session, capture_name, request).solve(reading, searching);
}

}  // namespace nutik
