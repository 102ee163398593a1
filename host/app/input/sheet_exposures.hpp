// Exposures for a sheet: one capture, one mask, ever other functions.
#pragma once

#include <filesystem>
#include <span>
#include <string>

#include "app/input/exposer.hpp"
#include "sheet/contact_sheet.hpp"

namespace nutik::app {

// What --columns and --width ask for. Throws UsageError.
[[nodiscard]] sheet::SheetWishes sheet_wishes(const Options& options);

// Throws UsageError where a sheet, which has 8 bits and colour, cannot be written under this name.
void check_sheet_output(const std::filesystem::path& output, std::span<const std::string> inputs);

// The file that an operand or -o names, else `<capture>-<suffix>.png`.
[[nodiscard]] std::filesystem::path sheet_output(const Options& options, const std::string& command,
                                                 const std::string& suffix);

class SheetExposures {
 public:
  // The options and the capture must outlive it.
  SheetExposures(const Options& options, CaptureSource& capture, Mask mask, PlanOptions plan_options);

  // A picture of the capture's own codes, as expose would write it.
  [[nodiscard]] Exposed expose(const FunctionSet& functions);

  // What codes stand for: what was stated, else the capture's own.
  [[nodiscard]] const Transfer& transfer() const { return transfer_; }
  // Of all pictures so far, together.
  [[nodiscard]] const Saturation& saturation() const { return saturation_; }
  [[nodiscard]] ValueType type() const { return format_.type; }
  [[nodiscard]] const Exposer& exposer() const { return exposer_; }

 private:
  CaptureSource& capture_;
  Mask mask_;
  PlanOptions plan_options_;
  Transfer transfer_;
  OutputFormat format_;
  Saturation saturation_;
  Exposer exposer_;
};

}  // namespace nutik::app
