#pragma once
/// The data set's card: what is in it, how it was made, what it lacks. README.md, with the head
/// that Hugging Face reads.

#include <string>

#include "tools/dataset/make_dataset.h"

namespace vinerow::dataset {

std::string data_card(const study::OpenStudy& open, const DatasetReport& report);

}  // namespace vinerow::dataset
