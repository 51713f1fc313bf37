#pragma once

#include <gtest/gtest.h>
#include <viwo/core/Error.h>

#include <initializer_list>
#include <string>

namespace viwo::testing
{
/** The action throws viwo::Error with one line that holds all of the parts. */
template <class Action>
void expectError(const Action& action, std::initializer_list<std::string> parts)
{
	try
	{
		action();
	}
	catch (const Error& e)
	{
		const std::string message = e.what();
		EXPECT_EQ(message.find('\n'), std::string::npos) << message;
		for (const auto& part : parts) EXPECT_NE(message.find(part), std::string::npos) << "'" << part << "' is not in: " << message;
		return;
	}
	ADD_FAILURE() << "no viwo::Error was thrown";
}
}  // namespace viwo::testing
