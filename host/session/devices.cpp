#include "session/devices.hpp"

#include <unistd.h>

#include <algorithm>
#include <atomic>
#include <cctype>
#include <chrono>
#include <cstdlib>
#include <string_view>

#include "capture/text.hpp"
#include "opencl/cache_folder.hpp"
#include "opencl/device_succession.hpp"
#include "opencl/device_team.hpp"
#include "render/reference_renderer.hpp"
#include "session/text/text_table.hpp"

namespace nutik {
namespace {

// What might have been meant, of the devices' and platforms' names in small letters.
std::vector<std::string> words_of(const std::vector<DeviceInfo>& devices) {
  std::vector<std::string> words;
  for (const DeviceInfo& device : devices) {
    std::string word;
    for (const char c : in_small_letters(device.name + " " + device.platform + " ")) {
      if (std::isalnum(static_cast<unsigned char>(c)) != 0) {
        word += c;
      } else if (!word.empty()) {
        words.push_back(std::exchange(word, {}));
      }
    }
  }
  return words;
}

std::vector<std::size_t> chosen(const std::vector<DeviceInfo>& devices, const std::string& wanted) {
  try {
    return choose_devices(devices, wanted);
  } catch (const DeviceError& error) {
    const std::vector<std::string> words = words_of(devices);
    const bool is_one_of_them = std::ranges::count(words, in_small_letters(wanted)) > 0;  // of several devices
    const std::string meant = wanted.size() < 3 || is_one_of_them ? "" : did_you_mean(in_small_letters(wanted), words);
    throw DeviceError(error.what(), Advice{meant.empty() ? "" : "\n" + meant.substr(2)});
  }
}

// The first process to ask has the drivers, and true. They work on threads of their own, which a forked process does
// not have: it would wait for them for ever.
bool claim_process() {
  static std::atomic<pid_t> user = 0;
  pid_t first = 0;
  return user.compare_exchange_strong(first, getpid()) || first == getpid();
}
void check_process() {
  if (claim_process()) return;
  throw DeviceError("this process was forked from one that had used the device, and a driver does not live in both; "
                    "spawn processes instead, or fork them before the device is used");
}

std::shared_ptr<Renderer> made(const ComputingRequest& request, Devices::Announce announce) {
  if (request.renderer == RendererKind::reference) return std::make_shared<ReferenceRenderer>();
  check_process();
  OpenClOptions options;
  const std::vector<DeviceInfo> all = list_devices();
  const std::vector<std::size_t> devices = chosen(all, request.device);
  options.device = devices.front();
  options.precision = request.precision;
  options.memory_bytes = request.memory.rendering_bytes();
  options.cache_folder = request.cache_folder.value_or(default_cache_folder());
  if (const std::string flaw = flaw_of_cache(options.cache_folder); !flaw.empty()) {
    options.cache_folder.clear();
    if (announce) announce(flaw);
  }
  options.tests_itself = request.tests_drivers;
  options.announce = std::move(announce);
  if (devices.size() > 1) return std::make_shared<DeviceTeam>(devices, options);
  if (request.device.empty() && all.size() > 1) return std::make_shared<DeviceSuccession>(all, options);
  return std::make_shared<OpenClRenderer>(options);
}

}  // namespace

ComputingRequest ComputingRequest::of_environment() {
  ComputingRequest request;
  if (const char* device = std::getenv("NUTIK_DEVICE")) request.device = device;
  const char* self_test = std::getenv("NUTIK_SELF_TEST");
  request.tests_drivers = self_test == nullptr || std::string_view(self_test) != "off";
  return request;
}

std::map<Precision, Verdict> known_verdicts(std::size_t device) {
  const std::filesystem::path folder = default_cache_folder();
  return flaw_of_cache(folder).empty() ? kept_verdicts(device, folder) : std::map<Precision, Verdict>{};
}

Devices::Devices(const ComputingRequest& request, Announce announce)
    : request_(request), announce_(std::move(announce)) {}

void Devices::start() {
  std::call_once(started_,
                 [this] { starting_ = std::async(std::launch::async, made, request_, announce_).share(); });
}

Renderer& Devices::renderer() {
  start();
  if (request_.renderer == RendererKind::opencl) check_process();
  return *starting_.get();
}

std::shared_ptr<OpenClRenderer> Devices::opencl() {
  static_cast<void>(renderer());
  if (auto alone = std::dynamic_pointer_cast<OpenClRenderer>(starting_.get())) return alone;
  if (const auto* several = dynamic_cast<const DeviceSuccession*>(starting_.get().get())) return several->current();
  if (has_several()) {
    throw UsageError("several devices were asked for, and each is validated alone; name one of them",
                     Advice{": `device 0`"});
  }
  throw UsageError("the reference is no OpenCL device");
}

std::size_t Devices::count() {
  if (request_.renderer != RendererKind::opencl || !may_mean_several(request_.device)) return 1;
  const auto* team = dynamic_cast<DeviceTeam*>(&renderer());
  return team == nullptr ? 1 : team->size();
}

bool Devices::is_ready() {
  start();
  return starting_.wait_for(std::chrono::seconds(0)) == std::future_status::ready;
}

void Devices::keep_resident(const CaptureSource* source) {
  Renderer& named = renderer();
  const std::lock_guard lock(keeping_);
  if (std::exchange(resident_, source) != source) named.keep_resident(source);
}

void Devices::release(const CaptureSource* source) {
  const std::lock_guard lock(keeping_);
  if (resident_ != source || source == nullptr) return;
  resident_ = nullptr;
  if (request_.renderer == RendererKind::reference || claim_process()) renderer().keep_resident(nullptr);
}

}  // namespace nutik
