// The OpenCL renderer: exposes pictures with kernels/expose.cl and develop.cl, and combines samples with combine.cl.
#pragma once

#include <cstdint>
#include <filesystem>
#include <functional>
#include <map>
#include <memory>
#include <optional>
#include <span>
#include <string>

#include "opencl/device.hpp"
#include "opencl/self_test.hpp"
#include "render/renderer.hpp"

namespace nutik {

// The arithmetics that a device has, the fastest first (docs/explanation/accuracy.md): what choose_precision() takes.
[[nodiscard]] std::span<const Precision> precisions_of(const DeviceInfo& device);

struct OpenClOptions {
  std::size_t device = 0;              // index into list_devices()
  std::optional<Precision> precision;  // none: the fastest that is right enough, chosen for each picture. A
                                       // render may ask for another (RenderControl)
  std::filesystem::path cache_folder;  // of built kernels; empty: none
  std::function<void(const std::string& message)> announce;  // told what takes long; may be empty

  // For blocks of captures, on the device or where it reads the host's memory: half of it for those of a resident
  // capture, half at most for those on their way. A block that is larger is taken all the same. 0: 4 GB. Never
  // more than half of the device's memory. Gain tables and maps of functions that stay between renders take an eighth
  // besides.
  std::uint64_t memory_bytes = 0;

  // How the work is cut. 0 leaves it to the device; the picture does not depend on it beyond rounding.
  std::uint32_t item_pixels = 0;       // pixels of a tile that a work-item owns: 1 … 64, a power of two
  std::uint32_t item_tiles = 0;        // tiles in a row that a work-item owns pixels of
  std::uint32_t lanes = 0;             // of them that it works on at a time: 1, 4, 8 or 16
  std::uint32_t group_items = 0;       // work-items in a work-group
  std::uint32_t rows_at_once = 0;      // of which loads are under way at once
  std::optional<std::uint32_t> table_copies;  // of light of 256 codes beside a work-group; 0: none
  bool use_fma = true;                 // false: as on a device that does not fuse multiplication and addition
  std::uint64_t chunk_bytes = 0;       // of blocks that one launch reads
  std::uint64_t allocation_bytes = 0;  // the largest buffer, at most the device's own (allocation_cuts.hpp)
  bool last_block_first = false;       // within a chunk: sums of whole numbers do not depend on it

  // Whether 16 lanes permute a transfer function's pieces (light_source.hpp). None: if the device's vectors hold them.
  std::optional<bool> permutes_pieces;
  std::optional<bool> looks_up_bytes;  // whether rows of 8 bits find it byte by byte instead; none: if that is fast

  bool tests_itself = true;                 // false: computes in whatever is chosen, right or not
  bool heeds_loop_limit = true;             // false: as if the driver had none (DeviceInfo::loop_limit)
  std::map<Precision, std::string> faults;  // build options that make kernels compute wrongly; for tests
};

// What is known of a device: the worst verdict on each of its arithmetics that was tested since its kernels were built.
[[nodiscard]] std::map<Precision, Verdict> kept_verdicts(std::size_t device,
                                                         const std::filesystem::path& cache_folder);

// Kernels are tested before a picture is computed with them (self_test.hpp): none is in an arithmetic that this device
// gets wrong, unless it was asked for by name; then a warning says so.
//
// Renders take turns at the device: any number of threads may ask. What they share is the device, its kernels and the
// blocks of the resident capture.
class OpenClRenderer final : public Renderer {
 public:
  // Throws DeviceError where the device is absent or cannot compute in the precision asked for.
  explicit OpenClRenderer(const OpenClOptions& options);
  ~OpenClRenderer() override;

  [[nodiscard]] const DeviceInfo& info() const;
  // What the device has, the fastest first.
  [[nodiscard]] std::span<const Precision> precisions() const;

  // What the device gets wrong of such pictures in an arithmetic, for a person to read; empty: nothing. Kernels are
  // built and tested for it, once. Throws DeviceError where it does not have the arithmetic, or fails.
  [[nodiscard]] std::string fault_in(Precision precision, const RenderPlan& plan, const OutputFormat& output);

  void keep_resident(const CaptureSource* source) override;
  void prepare(const RenderPlan& plan, const OutputFormat& output) override;
  [[nodiscard]] std::string name() const override;

 private:
  [[nodiscard]] Rendered render_part(const RenderPlan& plan, CaptureSource& source,
                                     const OutputFormat& output, const Rectangle& rectangle,
                                     const RenderControl& control) override;

  class Implementation;
  std::unique_ptr<Implementation> implementation_;
};

}  // namespace nutik
