#pragma once

#include "RunProgram.h"

#include <gtest/gtest.h>

#include <string>
#include <vector>

namespace viwo::testing
{
/** One clear line that holds the parts, nothing on stdout, and the status of a failure or of bad usage. */
inline void expectRefused(const ProgramResult& result, const std::vector<std::string>& parts)
{
	EXPECT_TRUE(result.status == 1 || result.status == 2) << result.status;
	EXPECT_EQ(result.errorLines(), 1u) << result.err;
	EXPECT_EQ(result.out, "");
	for (const std::string& part : parts)
		EXPECT_NE(result.err.find(part), std::string::npos) << "'" << part << "' is not in: " << result.err;
}

inline void expectDone(const ProgramResult& result)
{
	EXPECT_EQ(result.status, 0) << result.err;
}
}  // namespace viwo::testing
