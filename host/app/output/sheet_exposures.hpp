// Exposures for a sheet: one capture, one mask, ever other functions.
#pragma once

#include <filesystem>
#include <span>
#include <string>

#include "app/command_line/options.hpp"
#include "app/output/exposure_tally.hpp"
#include "session/session.hpp"
#include "session/sheets.hpp"

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
  // The session must outlive it.
  SheetExposures(const Options& options, Session& session, Mask mask, PlanOptions plan_options);

  // A picture of the capture's own codes, as expose would write it.
  [[nodiscard]] ExposedPicture expose(const FunctionSet& functions);

  // What codes stand for: what was stated, else the capture's own.
  [[nodiscard]] const Transfer& transfer() const { return transfer_; }
  // Of all pictures so far, together.
  [[nodiscard]] const ExposureTally& tally() const { return tally_; }
  [[nodiscard]] ValueType type() const { return format_.type; }

 private:
  Session& session_;
  Mask mask_;
  PlanOptions plan_options_;
  Transfer transfer_;
  OutputFormat format_;
  ExposureTally tally_;
};

}  // namespace nutik::app
