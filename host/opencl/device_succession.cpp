#include "opencl/device_succession.hpp"

#include <exception>
#include <utility>

#include "capture/error.hpp"
#include "capture/format.hpp"

namespace nutik {

DeviceSuccession::DeviceSuccession(std::vector<DeviceInfo> devices, const OpenClOptions& options)
    : devices_(std::move(devices)), options_(options) {
  start_next();
}

std::shared_ptr<OpenClRenderer> DeviceSuccession::current() const {
  const std::scoped_lock lock(mutex_);
  return current_;
}

bool DeviceSuccession::start_next() {
  std::exception_ptr first;
  while (next_ < devices_.size()) {
    options_.device = next_++;
    try {
      current_ = std::make_shared<OpenClRenderer>(options_);
      current_->keep_resident(resident_);
      return true;
    } catch (const DeviceError& error) {
      if (!first) first = std::current_exception();
      untold_.push_back(format("device {}, {}: {}. The next one takes its place", options_.device,
                               devices_[options_.device].name, error.what()));
    }
  }
  if (!current_) std::rethrow_exception(first);
  return false;
}

bool DeviceSuccession::leave(const std::shared_ptr<OpenClRenderer>& failed, const DeviceError& error) {
  const std::scoped_lock lock(mutex_);
  if (current_ != failed) return true;
  const std::size_t number = options_.device;
  if (!start_next()) return false;
  untold_.push_back(format("device {}: {}. Device {}, {}, computes from here on", number, error.what(), options_.device,
                           current_->name()));
  return true;
}

void DeviceSuccession::keep_resident(const CaptureSource* source) {
  const std::scoped_lock lock(mutex_);
  resident_ = source;
  current_->keep_resident(source);
}

void DeviceSuccession::prepare(const RenderPlan& plan, const OutputFormat& output) {
  const std::shared_ptr<OpenClRenderer> renderer = current();
  try {
    renderer->prepare(plan, output);
  } catch (const DeviceError& error) {
    if (!leave(renderer, error)) throw;
  }
}

Rendered DeviceSuccession::render_part(const RenderPlan& plan, CaptureSource& source, const OutputFormat& output,
                                       const Rectangle& rectangle, const RenderControl& control) {
  RenderControl of_part = control;
  of_part.rectangle = rectangle;
  for (;;) {
    const std::shared_ptr<OpenClRenderer> renderer = current();
    try {
      Rendered rendered = renderer->render(plan, source, output, of_part);
      const std::scoped_lock lock(mutex_);
      for (std::string& warning : std::exchange(untold_, {})) rendered.warnings.push_back(std::move(warning));
      return rendered;
    } catch (const DeviceError& error) {
      if (source.is_forward_only() || !leave(renderer, error)) throw;
    }
  }
}

}  // namespace nutik
