// Makes plans, and keeps their parts for the next ones: each part as long as what it was made from stays the same.
//
//   part                            made from
//   a mask's map                    the mask, the time map
//   a function's table and course   the function, the capture's timeline and blocks; with a time map they are made anew
//
//   always:  a plan is the same whether its parts were kept or made. It shares them, and may outlive the cache
//   threads: safe from any number
#pragma once

#include <cstdint>
#include <list>
#include <memory>
#include <mutex>

#include "render/render_plan.hpp"

namespace nutik {

struct PlanStatistics {
  std::uint64_t tables_made = 0;  // of one function over a run of blocks, those that had been dropped again
  std::uint64_t maps_made = 0;
  std::uint64_t table_bytes = 0;  // that tables take now
};

class PlanCache {
 public:
  static constexpr std::uint64_t kTableBytes = 256u << 20;

  // `table_bytes` is what the tables of functions may take between exposures; what does not fit is made again. Maps
  // come on top: of two masks, a byte a pixel each.
  explicit PlanCache(std::uint64_t table_bytes = kTableBytes);

  // As make_plan(), which it stands behind.
  [[nodiscard]] RenderPlan plan(const CaptureSource& source, const FunctionSet& functions, const Mask& mask,
                                const PlanOptions& options);

  [[nodiscard]] PlanStatistics statistics() const;

 private:
  std::shared_ptr<const CaptureLayout> layout_of(const CaptureSource& source);
  std::shared_ptr<const MaskMap> map_of(const Mask& mask, const std::shared_ptr<const DelayMap>& delays);
  void plan_delayed(RenderPlan& plan, const FunctionSet& functions, const PlanOptions& options);
  std::shared_ptr<const GainTable> table_of(const GainFunction& function, bool live_all,
                                            const std::shared_ptr<const CaptureLayout>& layout);

  mutable std::mutex mutex_;
  std::shared_ptr<TableMemory> memory_;
  std::shared_ptr<const CaptureLayout> layout_;         // that the tables are of
  std::list<std::shared_ptr<const MaskMap>> maps_;      // the one used last first
  std::list<std::shared_ptr<const GainTable>> tables_;  // likewise
  std::uint64_t maps_made_ = 0;
};

}  // namespace nutik
