#include "render/plan_cache.hpp"

#include <algorithm>
#include <array>

#include "capture/error.hpp"
#include "capture/format.hpp"
#include "exposure/mask_check.hpp"
#include "render/delayed_course.hpp"

namespace nutik {
namespace {

constexpr std::size_t kKeptMaps = 2;
constexpr std::size_t kKeptTables = 4 * kMaskValues;  // their numbers count in bytes besides

// Every delayed function has control points of its own, here and where it is exposed: half a gigabyte of them at most.
constexpr std::uint64_t kMaxDelayedPoints = 1u << 24;

// The first of a list that `is_it`, which becomes the list's first; null if there is none.
template <typename Part, typename Is>
std::shared_ptr<const Part> find_recent(std::list<std::shared_ptr<const Part>>& parts, Is is_it) {
  const auto found = std::ranges::find_if(parts, [&](const auto& part) { return is_it(*part); });
  if (found == parts.end()) return nullptr;
  parts.splice(parts.begin(), parts, found);
  return parts.front();
}

template <typename Part>
std::shared_ptr<const Part> keep(std::list<std::shared_ptr<const Part>>& parts,
                                 std::shared_ptr<const Part> made, std::size_t most) {
  parts.push_front(std::move(made));
  if (parts.size() > most) parts.pop_back();
  return parts.front();
}

void check_mapped(const FunctionSet& functions, const std::vector<MaskRegion>& regions) {
  std::array<std::uint64_t, kMaskValues> pixels{};
  std::array<bool, kMaskValues> is_mapped{};
  for (const MaskRegion& region : regions) pixels[region.tag] += region.pixel_count;
  for (const auto& [tag, function] : functions) is_mapped[tag] = true;
  if (const std::string mistake = unmapped_mistake(pixels, is_mapped); !mistake.empty()) {
    throw InputError(mistake, {Setting::unmapped});
  }
}

void warn(RenderPlan& plan, const PlannedFunction& function, bool was_unmapped,
          const std::string& function_name) {
  const std::string name = function_name.empty() ? format("M{}", function.tag) : function_name;
  for (const FunctionFinding& finding : function.table->findings()) {
    if (finding.kind == FunctionFinding::Kind::zero_everywhere && was_unmapped) continue;  // as it was asked
    plan.warnings.push_back(format("{}: {}", name, finding.message));
  }
}

void check_point_count(const MaskMap& map, const FunctionSet& functions) {
  std::uint64_t count = 0;
  for (const MaskRegion& region : map.regions) {
    const auto found = functions.find(region.tag);
    count += found == functions.end() ? 1 : found->second.points().size();
  }
  if (count <= kMaxDelayedPoints) return;
  throw InputError(
      format("{} pairs of a function and a delay have {} control points, and there can be {}; use functions "
             "with fewer points, or a map of delays with fewer values, of 8 bits for example",
             map.regions.size(), count, kMaxDelayedPoints));
}

void plan_blocks(RenderPlan& plan) {
  std::uint64_t row = 0;
  for (std::uint64_t block = 0; block < plan.layout->blocks.size(); ++block) {
    const BlockExtent& extent = plan.layout->blocks[block];
    const bool is_live = std::ranges::any_of(plan.functions, [&](const PlannedFunction& function) {
      return function.live.first < extent.range().last && extent.first_sample < function.live.last;
    });
    if (!is_live) continue;
    plan.blocks.push_back({block, extent, row});
    row += plan.blocks.back().row_count();
  }
}

}  // namespace

PlanCache::PlanCache(std::uint64_t table_bytes) : memory_(std::make_shared<TableMemory>(table_bytes)) {}

RenderPlan PlanCache::plan(const CaptureSource& source, const FunctionSet& functions, const Mask& mask,
                           const PlanOptions& options) {
  RenderPlan plan;
  plan.combine = options.combine;
  plan.capture = source.format();
  if (options.transfer) plan.capture.transfer = Transfer::restated(plan.capture.transfer, *options.transfer);
  check_size(mask, plan.capture);
  if (mask.tags.size() != std::size_t{mask.width} * mask.height) {
    throw InputError(format("the mask is {} x {} pixels and has {} tags; each pixel needs one", mask.width,
                            mask.height, mask.tags.size()));
  }
  plan.map = map_of(mask, options.delays);
  if (!options.unmapped_is_zero) check_mapped(functions, plan.map->regions);
  plan.layout = layout_of(source);
  plan.duration_ns = plan.layout->timeline.duration_ns();
  if (options.delays) {
    plan_delayed(plan, functions, options);
    plan_blocks(plan);
    return plan;
  }
  const GainFunction zero({{0, 0.0}});
  for (const MaskRegion& region : plan.map->regions) {
    const auto found = functions.find(region.tag);
    const bool unmapped = found == functions.end();
    auto table = table_of(unmapped ? zero : found->second, options.live_all, plan.layout);
    plan.functions.push_back({region.tag, table->function(), table->summary(), table->live(),
                              region.pixel_count, std::move(table), false, 0});
    warn(plan, plan.functions.back(), unmapped, options.function_name);
  }
  plan_blocks(plan);
  return plan;
}

// A function for each region: the delayed one, which has the D of its whole course.
void PlanCache::plan_delayed(RenderPlan& plan, const FunctionSet& functions, const PlanOptions& options) {
  check_point_count(*plan.map, functions);
  std::optional<DelayedCourse> course;
  for (const MaskRegion& region : plan.map->regions) {
    if (!course || course->tag() != region.tag) {
      if (course) course->warn(plan.warnings, options.function_name);
      course.emplace(region.tag, functions, plan.duration_ns);
    }
    auto table =
        std::make_shared<const GainTable>(course->function().shifted(region.delay_ns), options.live_all,
                                          plan.layout, memory_, course->support_ns());
    course->count(region, table->summary());
    plan.functions.push_back({region.tag, course->function(), table->summary(), table->live(),
                              region.pixel_count, std::move(table), true, region.delay_ns});
  }
  if (course) course->warn(plan.warnings, options.function_name);
}

PlanStatistics PlanCache::statistics() const {
  const std::scoped_lock lock(mutex_);
  return {memory_->runs_made(), maps_made_, memory_->bytes()};
}

std::shared_ptr<const CaptureLayout> PlanCache::layout_of(const CaptureSource& source) {
  const std::scoped_lock lock(mutex_);
  if (!layout_ || !layout_->is_of(source)) {
    layout_ = CaptureLayout::of(source);
    tables_.clear();
  }
  return layout_;
}

std::shared_ptr<const MaskMap> PlanCache::map_of(const Mask& mask,
                                                 const std::shared_ptr<const DelayMap>& delays) {
  const std::scoped_lock lock(mutex_);
  if (auto kept = find_recent(maps_, [&](const MaskMap& map) { return map.is_of(mask, delays.get()); })) {
    return kept;
  }
  ++maps_made_;
  return keep(maps_, MaskMap::of(mask, delays), kKeptMaps);
}

std::shared_ptr<const GainTable> PlanCache::table_of(const GainFunction& function, bool live_all,
                                                     const std::shared_ptr<const CaptureLayout>& layout) {
  const std::scoped_lock lock(mutex_);
  const auto make = [&] { return std::make_shared<const GainTable>(function, live_all, layout, memory_); };
  if (layout != layout_) return make();  // another thread asked for another capture meanwhile
  if (auto kept = find_recent(tables_, [&](const GainTable& table) {
        return table.is_live_everywhere() == live_all && table.function() == function;
      })) {
    return kept;
  }
  return keep(tables_, make(), kKeptTables);
}

}  // namespace nutik
