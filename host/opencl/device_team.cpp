#include "opencl/device_team.hpp"

#include <algorithm>
#include <chrono>
#include <cstring>
#include <exception>
#include <iterator>
#include <mutex>
#include <numeric>
#include <set>
#include <stop_token>
#include <thread>
#include <utility>

#include "capture/error.hpp"
#include "capture/format.hpp"
#include "capture/text.hpp"
#include "opencl/arithmetic_choice.hpp"
#include "opencl/render_memory.hpp"

namespace nutik {
namespace {

// Pixels that a device works on at a time, clocks aside: a GPU's unit has some 64 lanes, a processor's core those of
// its vectors. It is only where to begin: how long pictures take is measured.
double apparent_speed(const DeviceInfo& info) {
  const double lanes = info.kind == DeviceKind::gpu ? 64.0 : std::max(info.native_float_lanes, 1u);
  return std::max(info.compute_units, 1u) * lanes;
}

// Devices that are alike announce the same: that is said once.
std::function<void(const std::string&)> each_once(std::function<void(const std::string&)> announce) {
  if (!announce) return {};
  struct Said {
    std::mutex mutex;
    std::set<std::string> texts;
  };
  return [said = std::make_shared<Said>(), announce = std::move(announce)](const std::string& text) {
    const std::scoped_lock lock(said->mutex);
    if (said->texts.insert(text).second) announce(text);
  };
}

std::vector<Precision> common_precisions(std::span<const Precision> of_first, const auto& members) {
  std::vector<Precision> common;
  std::ranges::copy_if(of_first, std::back_inserter(common), [&](Precision precision) {
    return std::ranges::all_of(members, [&](const auto& member) {
      return std::ranges::count(member.renderer->precisions(), precision) > 0;
    });
  });
  return common;
}

[[noreturn]] void throw_numbered(std::size_t device, const DeviceError& error) {
  const std::string text = format("device {}: {}", device, error.what());
  if (!error.advice().empty()) throw DeviceError(text, Advice{error.advice()});
  throw DeviceError(text, error.settings());
}

}  // namespace

DeviceTeam::DeviceTeam(std::span<const std::size_t> devices, const OpenClOptions& options)
    : precision_(options.precision) {
  if (devices.empty()) throw UsageError("a team has one device at least");
  OpenClOptions own = options;
  own.memory_bytes = options.memory_bytes / devices.size();
  own.announce = each_once(options.announce);
  std::vector<double> speeds;
  for (const std::size_t device : devices) {
    own.device = device;
    try {
      members_.push_back({device, std::make_unique<OpenClRenderer>(own)});
    } catch (const DeviceError& error) {
      throw_numbered(device, error);
    }
    speeds.push_back(apparent_speed(members_.back().renderer->info()));
  }
  all_.resize(members_.size());
  std::iota(all_.begin(), all_.end(), std::size_t{0});
  available_ = common_precisions(members_.front().renderer->precisions(), members_);
  split_.emplace(speeds);
  free_.insert(all_.begin(), all_.end());
}

// Calls task(member, stop) for each, one on this thread and the others on their own. The first error is thrown when all
// have ended; it stops the others.
template <typename Task>
void DeviceTeam::on_each(std::span<const std::size_t> members, const std::stop_token& outer, Task task) const {
  std::stop_source stop;
  const std::stop_callback passed_on(outer, [&stop] { stop.request_stop(); });
  std::exception_ptr failure;
  std::mutex failing;
  const auto fail = [&] {
    const std::scoped_lock lock(failing);
    if (!failure) failure = std::current_exception();
    stop.request_stop();
  };
  const auto run = [&](std::size_t member) {
    try {
      try {
        task(member, stop.get_token());
      } catch (const DeviceError& error) {
        throw_numbered(members_[member].device, error);
      }
    } catch (...) {
      fail();
    }
  };
  {
    std::vector<std::jthread> others;
    try {
      for (const std::size_t member : members.subspan(1)) others.emplace_back(run, member);
    } catch (...) {
      fail();  // the system has no more threads
    }
    run(members.front());
  }
  if (failure) std::rethrow_exception(failure);
}

// A shared_mutex lets who shares it in past who waits for it alone: pictures of single devices that overlap without end
// would keep bands waiting without end. So all pass the door, one by one, and stand in it while they wait.
std::unique_lock<std::shared_mutex> DeviceTeam::turn_of_all() {
  const std::scoped_lock passing(door_);
  return std::unique_lock(turn_);
}
std::shared_lock<std::shared_mutex> DeviceTeam::turn_of_one() {
  const std::scoped_lock passing(door_);
  return std::shared_lock(turn_);
}

void DeviceTeam::keep_resident(const CaptureSource* source) {
  const std::unique_lock turn = turn_of_all();
  for (const Member& member : members_) member.renderer->keep_resident(source);
}

void DeviceTeam::prepare(const RenderPlan& plan, const OutputFormat& output) {
  const std::unique_lock turn = turn_of_all();
  Rendered ignored;
  choose(plan, output, precision_, {}, ignored);
}

std::string DeviceTeam::name() const { return names_of(all_); }

std::string DeviceTeam::names_of(std::span<const std::size_t> members) const {
  std::vector<std::pair<std::string, std::size_t>> counts;
  for (const std::size_t member : members) {
    const std::string name = members_[member].renderer->name();
    const auto same = std::ranges::find(counts, name, &std::pair<std::string, std::size_t>::first);
    if (same == counts.end()) {
      counts.emplace_back(name, 1);
    } else {
      ++same->second;
    }
  }
  return joined(counts, " and ", [](const auto& each) {
    return each.second == 1 ? each.first : format("{} x {}", each.second, each.first);
  });
}

void DeviceTeam::choose(const RenderPlan& plan, const OutputFormat& output, std::optional<Precision> asked,
                        const RenderControl& control, Rendered& rendered) {
  const std::scoped_lock choosing(choosing_);
  choose_arithmetic(
      plan, output, available_, asked, name(), control,
      [&](Precision precision) { return fault_of(precision, plan, output); }, rendered);
}

// A device that is busy would keep others waiting: each is asked once.
std::string DeviceTeam::fault_of(Precision precision, const RenderPlan& plan, const OutputFormat& output) {
  const bool is_mixed = !plan.map->mixed.empty(), has_delays = plan.map->has_delays();
  const auto known = std::ranges::find_if(known_faults_, [&](const KnownFault& each) {
    return each.precision == precision && each.is_mixed == is_mixed && each.has_delays == has_delays &&
           each.output == output && each.capture == plan.capture;
  });
  if (known != known_faults_.end()) return known->fault;
  std::vector<std::string> faults(members_.size());
  on_each(all_, {}, [&](std::size_t member, const std::stop_token&) {
    faults[member] = members_[member].renderer->fault_in(precision, plan, output);
  });
  std::string fault;
  for (const std::size_t member : all_) {
    if (fault.empty() && !faults[member].empty())
      fault = format("device {}: {}", members_[member].device, faults[member]);
  }
  if (!plan.blocks.empty()) known_faults_.push_back({precision, plan.capture, output, is_mixed, has_delays, fault});
  return fault;
}

Rendered DeviceTeam::render_part(const RenderPlan& plan, CaptureSource& source, const OutputFormat& output,
                                 const Rectangle& rectangle, const RenderControl& control) {
  const std::optional<Precision> asked = control.precision ? control.precision : precision_;
  Rendered chosen;
  if (plan.combine == Combine::integral) choose(plan, output, asked, control, chosen);
  RenderControl of_part = control;
  of_part.precision = chosen.precision;
  of_part.is_chosen = true;
  std::optional<Rendered> rendered;
  if (control.by_one_device && !source.is_forward_only()) {
    rendered = render_alone(plan, source, output, rectangle, of_part);
  }
  if (!rendered) rendered = render_together(plan, source, output, rectangle, of_part);
  rendered->precision = chosen.precision;
  rendered->choice = std::move(chosen.choice);
  rendered->warnings.insert(rendered->warnings.begin(), chosen.warnings.begin(), chosen.warnings.end());
  return std::move(*rendered);
}

std::size_t DeviceTeam::take_free(const std::stop_token& stop) {
  std::unique_lock lock(freeing_);
  const std::uint64_t place = next_in_line_++;
  // Also whoever is cancelled waits for its place, and does not keep it.
  // A request to stop wakes who waits for a device, and the second wait is for the place alone.
  freed_.wait(lock, stop, [&] { return served_ == place && !free_.empty(); });
  freed_.wait(lock, [&] { return served_ == place; });
  ++served_;
  freed_.notify_all();
  if (stop.stop_requested()) throw Cancelled();
  return free_.extract(free_.begin()).value();
}

void DeviceTeam::give_back(std::size_t member) {
  const std::scoped_lock lock(freeing_);
  free_.insert(member);
  freed_.notify_all();
}

std::optional<Rendered> DeviceTeam::render_alone(const RenderPlan& plan, CaptureSource& source,
                                                 const OutputFormat& output, const Rectangle& rectangle,
                                                 const RenderControl& control) {
  const std::shared_lock turn = turn_of_one();
  RenderControl own = control;
  if (control.memory_bytes != 0) {
    own.memory_bytes = control.memory_bytes / members_.size();
    const Shape shape{rectangle.width, rectangle.height, plan.capture.shape.channels};
    const MemoryNeeds least = least_memory(plan, source, shape, output.type, *control.precision).needs;
    if (least.bytes() > own.memory_bytes) return std::nullopt;
  }
  own.rectangle = rectangle;
  const struct Taken {
    explicit Taken(DeviceTeam& of, const std::stop_token& stop) : team(of), member(team.take_free(stop)) {}
    ~Taken() { team.give_back(member); }
    DeviceTeam& team;
    std::size_t member;
  } taken(*this, control.stop);
  const auto& [device, renderer] = members_[taken.member];
  try {
    Rendered rendered = renderer->render(plan, source, output, own);
    rendered.renderer = name();
    return rendered;
  } catch (const DeviceError& error) {
    throw_numbered(device, error);
  }
}

Rendered DeviceTeam::render_together(const RenderPlan& plan, CaptureSource& source, const OutputFormat& output,
                                     const Rectangle& rectangle, const RenderControl& control) {
  const std::unique_lock turn = turn_of_all();
  std::vector<Rectangle> bands = split_->cut(rectangle);
  std::vector<std::size_t> at_work;
  std::ranges::copy_if(all_, std::back_inserter(at_work),
                       [&](std::size_t member) { return bands[member].height > 0; });
  if (source.is_forward_only()) {
    at_work = {0};
    bands.front() = rectangle;
  }
  Rendered rendered = render_bands(plan, source, output, rectangle, control, bands, at_work);
  rendered.renderer = names_of(at_work);
  return rendered;
}

Rendered DeviceTeam::render_bands(const RenderPlan& plan, CaptureSource& source, const OutputFormat& output,
                                  const Rectangle& rectangle, const RenderControl& control,
                                  std::span<const Rectangle> bands, std::span<const std::size_t> at_work) {
  const std::vector<std::uint64_t> shares =
      source.is_forward_only()
          ? std::vector(members_.size(), control.memory_bytes)
          : memory_of_bands(control.memory_bytes, plan, source, bands, output.type, *control.precision);
  std::vector<Rendered> made(members_.size());
  const auto make_band = [&](std::size_t member, std::stop_token stop) {
    RenderControl of_band = control;
    of_band.stop = std::move(stop);
    if (member != at_work.front()) of_band.progress = {};
    of_band.rectangle = bands[member];
    of_band.memory_bytes = shares[member];
    made[member] = members_[member].renderer->render(plan, source, output, of_band);
  };
  if (at_work.size() == 1) {
    on_each(at_work, control.stop, make_band);
    return std::move(made[at_work.front()]);
  }

  std::vector<double> seconds(members_.size(), 0.0);
  Rendered whole;
  const std::uint32_t channels = plan.capture.shape.channels;
  const std::uint64_t row_bytes = std::uint64_t{rectangle.width} * channels * value_bytes(output.type);
  whole.picture = Picture({rectangle.width, rectangle.height, channels}, output.type, output.white_code);
  on_each(at_work, control.stop, [&](std::size_t member, std::stop_token stop) {
    const auto start = std::chrono::steady_clock::now();
    make_band(member, std::move(stop));
    seconds[member] = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
    const Picture band = std::move(made[member].picture);
    std::memcpy(whole.picture.bytes.data() + (bands[member].y - rectangle.y) * row_bytes, band.bytes.data(),
                band.bytes.size());
  });
  split_->took(bands, seconds);
  for (const std::size_t member : at_work) add_part(whole, made[member], true);
  return whole;
}

}  // namespace nutik
