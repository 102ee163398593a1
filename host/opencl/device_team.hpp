// Several OpenCL devices that make each picture together: a band of its rows each, all at the same time.
//
//   always:  a picture in `fixed` is that of any of the devices alone, to the last bit; in other arithmetics a band is
//            what its device makes of it. All bands have one arithmetic: `auto` chooses among those that all devices have
//            and compute rightly. A capture that is read forward goes to the first device alone, a picture with one row
//            of tiles to one: Rendered::renderer says who made it
//   threads: any number may ask one. Renders take turns
#pragma once

#include <memory>
#include <mutex>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "opencl/band_split.hpp"
#include "opencl/opencl_renderer.hpp"
#include "render/renderer.hpp"

namespace nutik {

class DeviceTeam final : public Renderer {
 public:
  // `devices` are indices into list_devices(), one at least. Of the options, `device` is not looked at; the memory is
  // for all devices together. Throws DeviceError as OpenClRenderer does, with the device's number in front.
  DeviceTeam(std::span<const std::size_t> devices, const OpenClOptions& options);

  void keep_resident(const CaptureSource* source) override;
  void prepare(const RenderPlan& plan, const OutputFormat& output) override;
  [[nodiscard]] std::string name() const override;

 private:
  struct Member {
    std::size_t device;
    std::unique_ptr<OpenClRenderer> renderer;
  };

  // What is done on several of them at once; `outer` ends it.
  template <typename Work>
  void on_each(std::span<const std::size_t> members, const std::stop_token& outer, Work work) const;
  [[nodiscard]] std::string names_of(std::span<const std::size_t> members) const;
  void choose(const RenderPlan& plan, const OutputFormat& output, std::optional<Precision> asked,
              Rendered& rendered) const;
  [[nodiscard]] Rendered render_part(const RenderPlan& plan, CaptureSource& source,
                                     const OutputFormat& output, const Rectangle& rectangle,
                                     const RenderControl& control) override;
  [[nodiscard]] Rendered render_bands(const RenderPlan& plan, CaptureSource& source,
                                      const OutputFormat& output, const Rectangle& rectangle,
                                      const RenderControl& control, std::span<const Rectangle> bands,
                                      std::span<const std::size_t> at_work);

  std::optional<Precision> precision_;
  std::vector<Member> members_;
  std::vector<std::size_t> all_;      // 0, 1, …
  std::vector<Precision> available_;  // that all of them have, the fastest first
  std::optional<BandSplit> split_;
  std::mutex turn_;
};

}  // namespace nutik
