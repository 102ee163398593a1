// The renderer of one session or of several. It starts in the background or when it is first needed.
//
//   threads: any number may use one
#pragma once

#include <filesystem>
#include <functional>
#include <future>
#include <map>
#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "capture/error.hpp"
#include "opencl/device.hpp"
#include "opencl/opencl_renderer.hpp"
#include "render/precision.hpp"
#include "render/renderer.hpp"
#include "session/memory_budget.hpp"

namespace nutik {

// The reference computes in double on the processor, slowly, and needs no OpenCL.
enum class RendererKind { opencl, reference };

// Which renderer computes pictures, with how much memory. A value: two are equal when they ask for the same.
struct ComputingRequest {
  RendererKind renderer = RendererKind::opencl;

  // An OpenCL device: its number in list_devices(), or part of its name or platform, in any case. Empty: the first.
  // Several with commas between them, or `all`, make each picture together.
  std::string device;
  std::optional<Precision> precision;  // none: for each picture the fastest whose error bound is small enough
  bool strict = false;  // pictures that may err by more than half a code are errors: ImpreciseError
  // Keeps built kernels. None: default_cache_folder(); an empty path: they are not kept.
  std::optional<std::filesystem::path> cache_folder;

  MemoryBudget memory = MemoryBudget::of_machine();

  bool tests_drivers = true;  // false: new kernels are used without a self-test (opencl/self_test.hpp)

  // With what the environment says: NUTIK_DEVICE names the device, NUTIK_SELF_TEST=off does without self-tests.
  static ComputingRequest of_environment();

  friend bool operator==(const ComputingRequest&, const ComputingRequest&) = default;
};

// For each arithmetic that was tested on a device, its worst verdict (opencl/self_test.hpp).
[[nodiscard]] std::map<Precision, Verdict> known_verdicts(std::size_t device);

class Devices {
 public:
  // Called with a whole line when something takes long: kernels are built. On any thread; may be empty.
  using Announce = std::function<void(const std::string& message)>;

  explicit Devices(const ComputingRequest& request, Announce announce = {});

  // Starts the device in the background, so that renderer() and opencl() wait less; they throw its errors. Optional.
  void start();

  [[nodiscard]] const ComputingRequest& request() const { return request_; }

  // Wait until the renderer has started. Throw DeviceError where none has the stated name or it cannot do what is
  // asked; opencl() throws UsageError if the reference or several were asked for.
  [[nodiscard]] Renderer& renderer();
  [[nodiscard]] std::shared_ptr<OpenClRenderer> opencl();  // stays when another device takes over
  // How many devices pictures are shared out among (opencl/device_team.hpp). Waits only where the request may mean
  // several.
  [[nodiscard]] std::size_t count();
  [[nodiscard]] bool has_several() { return count() > 1; }
  // Whether it has started.
  [[nodiscard]] bool is_ready();

  // Keeps blocks of this capture in the renderer's memory in place of the previous one's; null: of none.
  void keep_resident(const CaptureSource* source);
  // To be called before a capture is destroyed: its blocks are kept no longer.
  void release(const CaptureSource* source);

 private:
  ComputingRequest request_;
  Announce announce_;
  std::once_flag started_;
  std::shared_future<std::shared_ptr<Renderer>> starting_;
  std::mutex keeping_;  // guards the resident capture
  const CaptureSource* resident_ = nullptr;
};

}  // namespace nutik
