// Devices of which nobody named one: the first makes pictures until it fails, then the next takes over, for good.
//
//   always:  a picture is made by one device, all of it. The first one that another device made has a warning
//   not:     a capture that is read forward cannot be read again: where it fails halfway, that is thrown
//   threads: any number may ask
#pragma once

#include <memory>
#include <mutex>
#include <string>
#include <vector>

#include "opencl/opencl_renderer.hpp"
#include "render/renderer.hpp"

namespace nutik {

class DeviceSuccession final : public Renderer {
 public:
  // `devices` as list_devices() has them, the first of which that starts is started. Of the options, `device` is not
  // looked at. Throws DeviceError, that of the first, where none starts.
  DeviceSuccession(std::vector<DeviceInfo> devices, const OpenClOptions& options);

  // The device whose turn it is.
  [[nodiscard]] std::shared_ptr<OpenClRenderer> current() const;

  void keep_resident(const CaptureSource* source) override;
  void prepare(const RenderPlan& plan, const OutputFormat& output) override;
  [[nodiscard]] std::string name() const override { return current()->name(); }

 private:
  // Starts the next device that can be; false where there is none. The lock is held.
  bool start_next();
  // That a device failed; false where none is left to take over.
  bool leave(const std::shared_ptr<OpenClRenderer>& failed, const DeviceError& error);
  [[nodiscard]] Rendered render_part(const RenderPlan& plan, CaptureSource& source, const OutputFormat& output,
                                     const Rectangle& rectangle, const RenderControl& control) override;

  std::vector<DeviceInfo> devices_;
  OpenClOptions options_;
  mutable std::mutex mutex_;  // guards all that follows
  std::size_t next_ = 0;  // of devices
  std::shared_ptr<OpenClRenderer> current_;
  const CaptureSource* resident_ = nullptr;
  std::vector<std::string> untold_;
};

}  // namespace nutik
