# cmake -DBUILD=<viwo's build folder> -DCPACK=<cpack> -P MakePackages.cmake: the packages of the build as it stands, in packages_test, compressed in a hurry.
set(folder ${BUILD}/packages_test)
file(REMOVE_RECURSE ${folder})
execute_process(COMMAND ${CPACK} -G DEB -D CPACK_VIWO_COMPRESSION=gzip -B ${folder} WORKING_DIRECTORY ${BUILD} RESULT_VARIABLE status OUTPUT_VARIABLE output ERROR_VARIABLE output)
if(NOT status EQUAL 0)
	message(FATAL_ERROR "cpack failed (${status}):\n${output}")
endif()
file(REMOVE_RECURSE ${folder}/_CPack_Packages)
