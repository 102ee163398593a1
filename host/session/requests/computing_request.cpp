#include "session/requests/computing_request.hpp"

#include <cstdlib>
#include <string_view>

namespace nutik {

ComputingRequest ComputingRequest::of_environment() {
  ComputingRequest request;
  if (const char* device = std::getenv("NUTIK_DEVICE")) request.device = device;
  const char* self_test = std::getenv("NUTIK_SELF_TEST");
  request.tests_drivers = self_test == nullptr || std::string_view(self_test) != "off";
  return request;
}

}  // namespace nutik
