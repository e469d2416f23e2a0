#pragma once

#include <cstddef>
#include <cstdint>
#include <string>

namespace microinjection {

/// A table that is written to disk row by row. The rows are appended to PATH.active, which is
/// renamed to PATH when the table is complete, as rosbag does. Rows written by flush() survive any
/// end of the process.
///
/// A full disk is no error of the session: rows that cannot be written are dropped and counted, and
/// writing continues when there is space again. The file always consists of whole rows.
class RowFile {
 public:
  /// Creates missing directories and PATH.active with the line `header` (with its line break).
  /// Without space for the header, it is written before the first row.
  /// @throws std::runtime_error  with path and reason, when PATH.active cannot be created
  RowFile(std::string path, std::string header);
  /// Keeps PATH.active when finish() was not called.
  ~RowFile();
  RowFile(const RowFile&) = delete;
  RowFile& operator=(const RowFile&) = delete;

  /// Adds a row (with its line break); the next flush() writes it.
  void append(const std::string& row) { rows_ += row; }
  /// Hands the rows to the operating system; does not wait for the disk. Rows that cannot be
  /// written are lost, see errorText().
  void flush();
  /// Writes the remaining rows, waits for the disk and renames the file. Returns empty, or why the
  /// table at PATH is incomplete or missing; the written rows are kept then, too.
  std::string finish();

  /// Why the last attempt to write failed, with the path; empty after success.
  const std::string& errorText() const { return error_text_; }
  std::uint64_t lost() const { return lost_; }        ///< rows that were not written
  std::uint64_t written() const { return written_; }  ///< rows

 private:
  void drop(std::size_t kept, const std::string& text);
  std::string close();

  std::string path_, header_;
  int file_ = -1;
  std::string rows_;        ///< not written yet
  std::uint64_t size_ = 0;  ///< bytes of whole rows in the file, header included
  std::uint64_t lost_ = 0, written_ = 0;
  std::string error_text_;
  std::string reason_;  ///< of the last lost rows
};

}  // namespace microinjection
