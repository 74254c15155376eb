// SPDX-License-Identifier: MIT
#pragma once

#include "host/ask/tables.h"
#include "voxtact/voxtact.h"

struct vxt_answer {
    voxtact::AnswerTables object;
};
