#include "ros/plant_host.hpp"

int main(int argc, char** argv) { return fpc::runPlantHost(argc, argv); }
