// The OpenCL renderer: exposes pictures with kernels/expose.cl and kernels/develop.cl.
#pragma once

#include <cstdint>
#include <filesystem>
#include <functional>
#include <memory>
#include <string>
#include <string_view>

#include "render/renderer.hpp"

namespace nutik {

enum class Precision { single_, double_ };
Precision parse_precision(std::string_view text);  // `single` or `double`; throws UsageError
std::string to_text(Precision precision);

struct OpenClOptions {
  std::size_t device = 0;  // index into list_devices()
  Precision precision = Precision::double_;
  std::filesystem::path cache_folder;                        // of built kernels; empty: none
  std::function<void(const std::string& message)> announce;  // told what takes long; may be empty

  // How the work is cut. 0 leaves it to the device; the picture does not depend on it beyond rounding.
  std::uint32_t item_pixels = 0;  // pixels of a tile that a work-item owns: 1 … 64, a power of two
  std::uint32_t item_tiles = 0;   // tiles in a row that a work-item owns pixels of
  std::uint32_t lanes = 0;        // of them that it works on at a time: 1, 4, 8 or 16
  std::uint32_t group_items = 0;  // work-items in a work-group
  std::uint64_t chunk_bytes = 0;  // payload that is on the device at a time
};

// What the last render did.
struct RenderStatistics {
  double read_ms = 0.0;    // until payloads are where the kernel reads them: unpacking, copying
  double expose_ms = 0.0;  // of the kernels, by the device's own clock
  double develop_ms = 0.0;
  std::uint64_t payload_bytes = 0;  // read by the kernel
  std::uint64_t device_bytes = 0;   // largest sum of buffers at a time
  std::uint64_t blocks = 0;
  std::uint64_t launches = 0;
};

class OpenClRenderer final : public Renderer {
 public:
  // Throws DeviceError where the device is absent or cannot compute in the precision asked for.
  explicit OpenClRenderer(const OpenClOptions& options);
  ~OpenClRenderer() override;

  void prepare(const RenderPlan& plan, const OutputFormat& output) override;
  [[nodiscard]] Picture render(const RenderPlan& plan, CaptureSource& source,
                               const OutputFormat& output) override;
  [[nodiscard]] std::string name() const override;
  [[nodiscard]] std::string precision() const override;
  [[nodiscard]] std::string report() const override;
  [[nodiscard]] const RenderStatistics& statistics() const;

 private:
  class Implementation;
  std::unique_ptr<Implementation> implementation_;
};

}  // namespace nutik
