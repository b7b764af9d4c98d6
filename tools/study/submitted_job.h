#pragma once
/// What a study has submitted to a cluster, on the disk: so that the tasks know their cells, and a
/// driver that comes back finds the tasks that its forerunner left running.
///
///   <out>/slurm/<number>/chunks  cells of each task, a line a task
///                        study   digest of the study that they are of
///                        job.sh  what a task runs
///                        <task>.log

#include <filesystem>
#include <string>
#include <vector>

#include "tools/study/open_study.h"
#include "tools/study/study_folder.h"

namespace vinerow::study {

using Chunk = std::vector<std::size_t>;  ///< the cells of one task

struct SubmittedJob {
  std::filesystem::path folder;
  std::string name;    ///< in Slurm; no other study on the cluster has it
  std::string digest;  ///< of the study, Identity::whole()
  std::vector<Chunk> chunks;

  std::filesystem::path script() const { return folder / "job.sh"; }
};

/// Those of a study's folder, by number. What cannot be read is left out.
std::vector<SubmittedJob> submitted_jobs(const StudyFolder& folder);

/// Writes the files of a further one. @throws WriteError, ConfigError
SubmittedJob prepare_job(const OpenStudy& open, const StudyFolder& folder,
                         std::vector<Chunk> chunks);

/// Cells of one task. @throws ConfigError where the file has no such line
Chunk read_chunk(const std::filesystem::path& chunks, std::size_t task);

}  // namespace vinerow::study
