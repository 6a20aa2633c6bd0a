"""Where a robot can stand to reach a pose."""

from ravemj.compat.databases.model import DatabaseGenerator, refusing

REACH = "maps of what arms reach"


class InverseReachabilityModel(DatabaseGenerator):
    """Where a robot can stand to reach a pose."""

    capability = REACH

    classnormalizationconst = staticmethod(refusing("classnormalizationconst", REACH, "classstd"))
    computeAggregateBaseDistribution = refusing(
        "computeAggregateBaseDistribution", REACH, "self Tgrasps logllthresh zaxis"
    )
    computeBaseDistribution = refusing("computeBaseDistribution", REACH, "self Tgrasp logllthresh zaxis")
    getCloseIK = refusing("getCloseIK", REACH, "self Tgrasp")
    getEquivalenceClass = refusing("getEquivalenceClass", REACH, "self Tgrasp")
    getManipulatorLinks = staticmethod(refusing("getManipulatorLinks", REACH, "manip"))
    getdofindices = staticmethod(refusing("getdofindices", REACH, "manip"))
    necessaryjointstate = refusing("necessaryjointstate", REACH, "self")
    randomBaseDistributionIterator = refusing(
        "InverseReachabilityModel.randomBaseDistributionIterator",
        REACH,
        "self Tgrasps Nprematuresamples bounds **named",
    )
    sampleBaseDistributionIterator = refusing(
        "InverseReachabilityModel.sampleBaseDistributionIterator",
        REACH,
        "self Tgrasps logllthresh weight Nprematuresamples zaxis",
    )
    show = refusing("show", REACH, "self options")
    showBaseDistribution = staticmethod(
        refusing(
            "InverseReachabilityModel.showBaseDistribution",
            REACH,
            "env densityfn bounds zoffset thresh maxprob marginalizeangle",
        )
    )
    showEquivalenceClass = refusing(
        "InverseReachabilityModel.showEquivalenceClass",
        REACH,
        "self equivalenceclass transparency neighthresh onlymaniplinks",
    )
    testEquivalenceClass = refusing("testEquivalenceClass", REACH, "self equivalenceclass")
    testSampling = refusing("testSampling", REACH, "self heights N weight **named")


run = refusing("inversereachability.run", REACH, "*arguments **named")
