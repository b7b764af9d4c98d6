#pragma once
/// Files of jobs that a study has submitted to a cluster. Tasks read their cells from them, and a
/// restarted driver finds the tasks that the previous one left running.
///
///   <out>/slurm/<number>/chunks  cells of each task, one line per task
///                        study   digest of the study
///                        job.sh  script of a task
///                        <task>.log

#include <filesystem>
#include <string>
#include <vector>

#include "tools/study/open_study.h"
#include "tools/study/study_folder.h"

namespace vinerow::study {

using Chunk = std::vector<std::size_t>;  ///< cells of one task

struct SubmittedJob {
  std::filesystem::path folder;
  std::string name;    ///< name in Slurm, unique on the cluster
  std::string digest;  ///< digest of the study, Identity::whole()
  std::vector<Chunk> chunks;

  std::filesystem::path script() const { return folder / "job.sh"; }
};

/// Jobs in a study's folder, by number. Unreadable ones are left out.
std::vector<SubmittedJob> submitted_jobs(const StudyFolder& folder);

/// Writes the files of a new job. @throws WriteError, ConfigError
SubmittedJob prepare_job(const OpenStudy& open, const StudyFolder& folder,
                         std::vector<Chunk> chunks);

/// Cells of one task. @throws ConfigError if the file has no such line
Chunk read_chunk(const std::filesystem::path& chunks, std::size_t task);

}  // namespace vinerow::study
