// What computes the pictures of one session or of several: a renderer, started when it is first needed or before.
//
//   threads: any number may use one
#pragma once

#include <functional>
#include <future>
#include <map>
#include <memory>
#include <mutex>
#include <string>
#include <utility>
#include <vector>

#include "capture/error.hpp"
#include "opencl/device.hpp"
#include "opencl/opencl_renderer.hpp"
#include "render/renderer.hpp"
#include "session/computing_request.hpp"

namespace nutik {

// None, or more than one, is meant by what was stated; what() lists those found.
struct DeviceNotFound : DeviceError {
  std::string wanted;
  std::vector<DeviceInfo> devices;

  DeviceNotFound(const DeviceError& error, std::string stated, std::vector<DeviceInfo> found)
      : DeviceError(error), wanted(std::move(stated)), devices(std::move(found)) {}
};

// The worst kept verdict on each arithmetic of a device that was tested (opencl/self_test.hpp).
[[nodiscard]] std::map<Precision, Verdict> known_verdicts(std::size_t device);

class Devices {
 public:
  // Told what takes long, a whole line: kernels that are built. On any thread; may be empty.
  using Announce = std::function<void(const std::string& message)>;

  explicit Devices(const ComputingRequest& request, Announce announce = {});

  // Starts the device in the background. renderer() and opencl() wait for it, and throw the errors of that.
  // May be left out.
  void start();

  [[nodiscard]] const ComputingRequest& request() const { return request_; }

  // Wait until it is there. Throw DeviceNotFound, DeviceError where the device cannot do what is asked; opencl()
  // UsageError where the reference was asked for.
  [[nodiscard]] Renderer& renderer();
  [[nodiscard]] OpenClRenderer& opencl();
  // Whether it is there already.
  [[nodiscard]] bool is_ready();

  // Blocks of this capture stay where the renderer reads them from, those of the one before no longer. Null: of none.
  void keep_resident(const CaptureSource* source);
  // Before a capture goes: it is no longer the resident one.
  void release(const CaptureSource* source);

 private:
  ComputingRequest request_;
  Announce announce_;
  std::once_flag started_;
  std::shared_future<std::shared_ptr<Renderer>> starting_;
  std::mutex naming_;
  const CaptureSource* resident_ = nullptr;
};

}  // namespace nutik
