#include "app/input/renderer_choice.hpp"

#include <cctype>
#include <cstdlib>
#include <utility>

#include "app/command_line/suggestion.hpp"
#include "app/output/console.hpp"
#include "app/requests/source_words.hpp"
#include "capture/error.hpp"
#include "capture/format.hpp"
#include "opencl/device.hpp"
#include "opencl/program_store.hpp"
#include "render/reference_renderer.hpp"

namespace nutik::app {

namespace {

// Words of the devices' names, as they are written there.
std::vector<std::string> words_of(const std::vector<DeviceInfo>& devices) {
  std::vector<std::string> words;
  for (const DeviceInfo& device : devices) {
    std::string word;
    for (const char c : device.name + " " + device.platform + " ") {
      if (std::isalnum(static_cast<unsigned char>(c)) != 0) {
        word += c;
      } else if (!word.empty()) {
        words.push_back(std::exchange(word, {}));
      }
    }
  }
  return words;
}

std::size_t chosen_device(const std::vector<DeviceInfo>& devices, const std::string& wanted) {
  try {
    return choose_device(devices, wanted);
  } catch (const DeviceError& error) {
    // Case does not count in a device's name.
    const auto lower = [](std::string text) {
      for (char& c : text) c = static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
      return text;
    };
    std::vector<std::string> words = words_of(devices);
    for (std::string& word : words) word = lower(word);
    const std::string suggestion = did_you_mean(lower(wanted), words);
    if (suggestion.empty() || wanted.size() < 3) throw;
    throw DeviceError(error.what() + ("\n" + suggestion.substr(2)));
  }
}

}  // namespace

std::unique_ptr<OpenClRenderer> start_device(const Options& options) {
  const char* environment = std::getenv("NUTIK_DEVICE");
  const std::string wanted = options.device.value_or(environment != nullptr ? environment : "");
  const std::vector<DeviceInfo> devices = list_devices();
  OpenClOptions opencl;
  opencl.device = chosen_device(devices, wanted);
  if (options.precision.value_or("auto") != "auto") opencl.precision = parse_precision(*options.precision);
  opencl.memory_bytes = memory_budget(options).rendering_bytes();
  opencl.cache_folder = default_cache_folder();
  if (!options.quiet) opencl.announce = print_note;
  return std::make_unique<OpenClRenderer>(opencl);
}

std::unique_ptr<Renderer> choose_renderer(const Options& options) {
  const std::string name = options.renderer.value_or("opencl");
  if (name == "reference") {
    if (options.device) throw UsageError("--device chooses an OpenCL device; the reference uses none");
    if (options.precision) throw UsageError("--precision goes with OpenCL; the reference uses double");
    return std::make_unique<ReferenceRenderer>();
  }
  if (name != "opencl") {
    throw UsageError(format("renderer '{}' is not known; choose opencl or reference", name));
  }
  return start_device(options);
}

}  // namespace nutik::app
