#include "render/capture_layout.hpp"

#include <algorithm>

namespace nutik {

std::shared_ptr<const CaptureLayout> CaptureLayout::of(const CaptureSource& source) {
  auto layout = std::make_shared<CaptureLayout>(CaptureLayout{source.timeline(), {}, {}, {}});
  std::uint64_t samples = kRunSamples;
  for (std::uint64_t block = 0; block < source.block_count(); ++block) {
    if (samples >= kRunSamples) {
      layout->run_starts.push_back(block);
      samples = 0;
    }
    const BlockExtent& extent = layout->blocks.emplace_back(source.block_extent(block));
    layout->reaches.push_back({layout->timeline.reach_begin_ns(extent.first_sample),
                               layout->timeline.reach_end_ns(extent.range().last - 1)});
    samples += layout->blocks.back().sample_count;
  }
  layout->run_starts.push_back(layout->blocks.size());
  return layout;
}

std::size_t CaptureLayout::run_of(std::uint64_t block) const {
  return static_cast<std::size_t>(std::ranges::upper_bound(run_starts, block) - run_starts.begin()) - 1;
}

SampleRange CaptureLayout::samples(std::size_t run) const {
  return {blocks[run_starts[run]].first_sample, blocks[run_starts[run + 1] - 1].range().last};
}

bool CaptureLayout::is_of(const CaptureSource& source) const {
  if (source.block_count() != blocks.size()) return false;
  for (std::uint64_t block = 0; block < blocks.size(); ++block) {
    if (source.block_extent(block) != blocks[block]) return false;
  }
  return source.timeline() == timeline;
}

}  // namespace nutik
