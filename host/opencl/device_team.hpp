// Several OpenCL devices that make each picture together: a band of its rows each, all at the same time. Or each one
// pictures of its own, whichever is free, if they are asked for at the same time (RenderControl::by_one_device).
//
//   always:  a picture in `fixed` is that of any of the devices alone, to the last bit; in other arithmetics a band is
//            what its device makes of it. All bands have one arithmetic: `auto` chooses among those that all devices
//            have and compute rightly. A capture that is read forward goes to the first device alone, a picture with
//            one row of tiles to one: Rendered::renderer says who made it; all, if devices make pictures of their own
//   memory:  bands of a picture share what it may take; of pictures that devices make alone each takes an equal part.
//            Where that is too little for one, it is made in bands
//   threads: any number may ask one. Bands of one picture, and pictures of one device, take turns
#pragma once

#include <condition_variable>
#include <memory>
#include <mutex>
#include <optional>
#include <set>
#include <shared_mutex>
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
  [[nodiscard]] std::size_t size() const { return members_.size(); }

 private:
  struct Member {
    std::size_t device;
    std::unique_ptr<OpenClRenderer> renderer;
  };

  // What is known of an arithmetic on all members, for pictures that the same kernels make.
  struct KnownFault {
    Precision precision;
    CaptureFormat capture;
    OutputFormat output;
    bool is_mixed, has_delays;
    std::string fault;
  };
  [[nodiscard]] std::unique_lock<std::shared_mutex> turn_of_all();
  [[nodiscard]] std::shared_lock<std::shared_mutex> turn_of_one();
  // What is done on several of them at once; `outer` ends it.
  template <typename Task>
  void on_each(std::span<const std::size_t> members, const std::stop_token& outer, Task task) const;
  [[nodiscard]] std::string names_of(std::span<const std::size_t> members) const;
  void choose(const RenderPlan& plan, const OutputFormat& output, std::optional<Precision> asked,
              const RenderControl& control, Rendered& rendered);
  [[nodiscard]] std::string fault_of(Precision precision, const RenderPlan& plan, const OutputFormat& output);
  [[nodiscard]] Rendered render_part(const RenderPlan& plan, CaptureSource& source,
                                     const OutputFormat& output, const Rectangle& rectangle,
                                     const RenderControl& control) override;
  // The first that is free: whoever asks first is served first. Throws Cancelled.
  [[nodiscard]] std::size_t take_free(const std::stop_token& stop);
  void give_back(std::size_t member);
  // None where a device's part of the memory is too little.
  [[nodiscard]] std::optional<Rendered> render_alone(const RenderPlan& plan, CaptureSource& source,
                                                     const OutputFormat& output, const Rectangle& rectangle,
                                                     const RenderControl& control);
  [[nodiscard]] Rendered render_together(const RenderPlan& plan, CaptureSource& source,
                                         const OutputFormat& output, const Rectangle& rectangle,
                                         const RenderControl& control);
  [[nodiscard]] Rendered render_bands(const RenderPlan& plan, CaptureSource& source,
                                      const OutputFormat& output, const Rectangle& rectangle,
                                      const RenderControl& control, std::span<const Rectangle> bands,
                                      std::span<const std::size_t> at_work);

  std::optional<Precision> precision_;
  std::vector<Member> members_;
  std::vector<std::size_t> all_;      // 0, 1, …
  std::vector<Precision> available_;  // that all of them have, the fastest first
  std::mutex choosing_;               // guards the faults
  std::vector<KnownFault> known_faults_;
  std::mutex freeing_;  // guards the free ones, and who waits for one
  std::condition_variable_any freed_;
  std::set<std::size_t> free_;
  std::uint64_t next_in_line_ = 0, served_ = 0;
  std::mutex door_;         // to the turn
  std::shared_mutex turn_;  // of a picture in bands; shared by those that single devices make
  std::optional<BandSplit> split_;
};

}  // namespace nutik
