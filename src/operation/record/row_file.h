#pragma once

#include <cstddef>
#include <cstdint>
#include <string>

namespace microinjection {

/// A table that goes to disk as its rows come. The rows are appended to PATH.active, which gets the name PATH when the
/// table is complete, as rosbag does it. What flush() has written survives the end of the process, however it ends.
///
/// A full disk does not end anything: rows that cannot be written are dropped and counted, and writing goes on when
/// there is space again. The file always consists of whole rows.
class RowFile {
 public:
  /// Makes missing directories and PATH.active, empty but for `header`, a line with its end. Where there is no space
  /// for the header, it is written before the first row.
  /// @throws std::runtime_error  naming path and reason, when PATH.active cannot be made
  RowFile(std::string path, std::string header);
  /// Leaves PATH.active where finish() was not called.
  ~RowFile();
  RowFile(const RowFile&) = delete;
  RowFile& operator=(const RowFile&) = delete;

  /// Takes a row, a line with its end; it is written by the next flush().
  void append(const std::string& row) { rows_ += row; }
  /// Gives the rows to the system; does not wait for the disk. What cannot be written is lost, see trouble().
  void flush();
  /// Writes what is left, waits for the disk and renames the file. Empty, or why the table at PATH is not whole or not
  /// there; then, too, what could be written is kept.
  std::string finish();

  /// Why the last attempt to write failed, with the path; empty when it did not.
  const std::string& trouble() const { return trouble_; }
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
  std::string trouble_;
  std::string reason_;  ///< of the last rows that were lost
};

}  // namespace microinjection
