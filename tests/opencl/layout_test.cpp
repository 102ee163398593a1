// Host and kernels must lay out their shared structures alike, on every device.
#include <gtest/gtest.h>

#include "opencl/kernel_layout.hpp"
#include "opencl/kernel_sources.hpp"
#include "opencl/opencl_api.hpp"

namespace nutik {
namespace {

TEST(KernelLayout, IsTheHosts) {
  const std::vector<cl_uint> expected{sizeof(TileEntry),
                                      offsetof(TileEntry, offset),
                                      offsetof(TileEntry, count),
                                      sizeof(BlockPart),
                                      offsetof(BlockPart, span) + offsetof(SampleSpan, first),
                                      offsetof(BlockPart, span) + offsetof(SampleSpan, last),
                                      offsetof(BlockPart, bits),
                                      sizeof(BlockEntry),
                                      offsetof(BlockEntry, payload_offset),
                                      offsetof(BlockEntry, table_row),
                                      offsetof(BlockEntry, part_row),
                                      offsetof(BlockEntry, sample_count),
                                      offsetof(BlockEntry, kept_bits),
                                      sizeof(ExposeLaunch),
                                      offsetof(ExposeLaunch, tile_count),
                                      offsetof(ExposeLaunch, block_count),
                                      offsetof(ExposeLaunch, function_count),
                                      offsetof(ExposeLaunch, is_first),
                                      kTilePixels,
                                      kBlockAlignment,
                                      TileEntry::kRecordsFlag,
                                      kMixedFunctions,
                                      BlockPart::kSteady,
                                      BlockPart::kInBundle,
                                      BlockPart::kBundleStart,
                                      BlockPart::kBundleEnd,
                                      BlockPart::kSumShift};
  for (const cl::Device& device : all_devices()) {
    const cl::Context context(device);
    cl::CommandQueue queue(context, device);
    cl::Program program(context, std::string(kernel_source("layout_probe")));
    program.build({device}, "-cl-std=CL1.2");
    const cl::Buffer sizes(context, CL_MEM_READ_WRITE, expected.size() * sizeof(cl_uint));
    cl::KernelFunctor<cl::Buffer> probe(program, "layout_probe");
    probe(cl::EnqueueArgs(queue, cl::NDRange(1)), sizes);
    std::vector<cl_uint> found(expected.size());
    queue.enqueueReadBuffer(sizes, CL_TRUE, 0, found.size() * sizeof(cl_uint), found.data());
    EXPECT_EQ(found, expected) << device.getInfo<CL_DEVICE_NAME>();
  }
}

}  // namespace
}  // namespace nutik
