// Reads function files as the program does and says what it read, so that another reader can be compared.
//
//   in:   on standard input, any number of files: "BYTES DURATION_NS\n", then so many bytes
//   out:  on standard output, for each a line of JSON: the functions by mask value, each with its control
//         points and what it comes to over [0, DURATION_NS], and the report that people are shown
#include <cstdint>
#include <exception>
#include <iostream>
#include <nlohmann/json.hpp>
#include <string>

#include "exposure/function_file.hpp"

namespace {

nlohmann::json summary_of(const nutik::GainFunction& function, std::int64_t duration_ns) {
  const nutik::GainSummary summary = nutik::summarize(function, duration_ns);
  return {{"exponent", summary.exponent},
          {"integral_ns", summary.integral_ns},
          {"absolute_integral_ns", summary.absolute_integral_ns},
          {"support_ns", summary.support_ns},
          {"live", {summary.live.begin_ns, summary.live.end_ns}}};
}

nlohmann::json read(const std::string& bytes, std::int64_t duration_ns) {
  const nutik::FunctionFile file = nutik::parse_functions(bytes);
  nlohmann::json functions = nlohmann::json::object();
  for (const auto& [tag, parsed] : file.functions) {
    nlohmann::json points = nlohmann::json::array();
    for (const nutik::ControlPoint& point : parsed.function.points()) {
      points.push_back({point.time_ns, point.gain});
    }
    functions[std::to_string(tag)] = {{"points", std::move(points)},
                                      {"summary", summary_of(parsed.function, duration_ns)}};
  }
  return {{"functions", std::move(functions)}, {"report", file.report("FILE")}};
}

}  // namespace

int main() {
  try {
    std::size_t size = 0;
    std::int64_t duration_ns = 0;
    while (std::cin >> size >> duration_ns) {
      std::cin.get();  // the line feed
      std::string bytes(size, '\0');
      if (!std::cin.read(bytes.data(), static_cast<std::streamsize>(size))) {
        std::cerr << "standard input ends within a file\n";
        return 1;
      }
      std::cout << read(bytes, duration_ns).dump() << std::endl;
    }
    return 0;
  } catch (const std::exception& error) {  // dump() refuses a report that is no UTF-8
    std::cerr << error.what() << '\n';
    return 1;
  }
}
