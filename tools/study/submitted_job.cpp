#include "tools/study/submitted_job.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <map>
#include <sstream>

#include "engine/core/error.h"
#include "engine/core/files.h"
#include "engine/core/hash.h"
#include "engine/core/whole_file.h"
#include "engine/io/files/output_folder.h"
#include "tools/study/numbers.h"
#include "tools/study/shell_word.h"

namespace vinerow::study {
namespace {

namespace fs = std::filesystem;

std::vector<Chunk> chunks_in(const std::string& text) {
  std::vector<Chunk> chunks;
  std::istringstream lines(text);
  for (std::string line; std::getline(lines, line);) {
    Chunk& chunk = chunks.emplace_back();
    std::istringstream words(line);
    for (std::size_t cell = 0; words >> cell;) chunk.push_back(cell);
  }
  return chunks;
}

/// Unique name of a study's jobs on a shared cluster, made from the path of its folder.
std::string name_of(const fs::path& folder) {
  Hasher hasher;
  hasher.add(folder.parent_path().string());
  return fmt::format("vinerow-{}-{}", hasher.hex().substr(0, 12), folder.filename().string());
}

std::map<std::size_t, fs::path> numbered(const fs::path& parent) {
  std::map<std::size_t, fs::path> folders;
  std::error_code error;
  for (const auto& entry : fs::directory_iterator(parent, error)) {
    const auto number = number_in(entry.path().filename().string());
    if (number && *number >= 1.0) folders[static_cast<std::size_t>(*number)] = entry.path();
  }
  return folders;
}

std::string script_of(const OpenStudy& open, const StudyFolder& folder, const SubmittedJob& job) {
  const auto quoted = [](const fs::path& path) {
    return shell_quoted(fs::absolute(path).lexically_normal().string());
  };
  return fmt::format(
      "#!/bin/sh\n"
      "# Cells of a study: task k of the array runs the cells in line k of 'chunks', from 0.\n"
      "exec {} study cell {} --out {} --cells {} \\\n"
      "  --chunks {} --task \"$SLURM_ARRAY_TASK_ID\" --expect {} --jobs "
      "\"${{SLURM_CPUS_PER_TASK:-1}}\"\n",
      quoted(fs::read_symlink("/proc/self/exe")), quoted(open.study.file), quoted(folder.out),
      quoted(folder.cells), quoted(job.folder / "chunks"), job.digest);
}

}  // namespace

std::vector<SubmittedJob> submitted_jobs(const StudyFolder& folder) {
  std::vector<SubmittedJob> jobs;
  for (const auto& [number, path] : numbered(fs::absolute(folder.submitted()))) {
    const auto chunks = read_bytes(path / "chunks"), digest = read_bytes(path / "study");
    if (chunks && digest) jobs.push_back({path, name_of(path), *digest, chunks_in(*chunks)});
  }
  return jobs;
}

SubmittedJob prepare_job(const OpenStudy& open, const StudyFolder& folder,
                         std::vector<Chunk> chunks) {
  const fs::path parent = fs::absolute(folder.submitted()).lexically_normal();
  const auto taken = numbered(parent);
  const std::size_t number = taken.empty() ? 1 : taken.rbegin()->first + 1;
  SubmittedJob job;
  job.folder = parent / std::to_string(number);
  job.name = name_of(job.folder);
  job.digest = open.identity.whole();
  job.chunks = std::move(chunks);
  io::make_folder(job.folder);
  std::string lines;
  for (const Chunk& chunk : job.chunks) lines += fmt::format("{}\n", fmt::join(chunk, " "));
  write_whole_file(job.folder / "chunks", lines);
  write_whole_file(job.folder / "study", job.digest);
  write_whole_file(job.script(), script_of(open, folder, job));
  return job;
}

Chunk read_chunk(const fs::path& chunks, std::size_t task) {
  const std::vector<Chunk> all = chunks_in(read_bytes(chunks).value_or(""));
  if (task < all.size()) return all[task];
  throw ConfigError(fmt::format("'{}' has no line {}", chunks.string(), task));
}

}  // namespace vinerow::study
