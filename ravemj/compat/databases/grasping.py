"""Grasps of a body by a hand."""

from ravemj.compat.databases.model import DatabaseGenerator, refusing

GRASPS = "planning of grasps"


class GraspingModel(DatabaseGenerator):
    """Grasps of a body by a hand."""

    capability = GRASPS
    graspsetname = ""

    def load(self, filename: str | None = None) -> bool:
        """Return whether there is something to use: False."""
        del filename
        return False

    ComputeCircleApproachRays = refusing(
        "GraspingModel.ComputeCircleApproachRays",
        GRASPS,
        "self center normalaxis delta normalanglerange directiondelta",
    )
    CreateOptionParser = staticmethod(refusing("CreateOptionParser", GRASPS, ""))
    GetLocalGraspTransform = refusing("GetLocalGraspTransform", GRASPS, "self grasp collisionfree")
    GripperVisibility = staticmethod(refusing("GripperVisibility", GRASPS, "manip"))
    InitializeFromParser = staticmethod(
        refusing("InitializeFromParser", GRASPS, "Model parser defaultviewer args *margs **named")
    )
    autogenerateparams = refusing("autogenerateparams", GRASPS, "self options")
    computeBoxApproachRays = refusing("computeBoxApproachRays", GRASPS, "self delta normalanglerange directiondelta")
    computePlaneApproachRays = refusing(
        "GraspingModel.computePlaneApproachRays",
        GRASPS,
        "self center sidex sidey delta normalanglerange directiondelta",
    )
    computeSphereApproachRays = refusing(
        "computeSphereApproachRays", GRASPS, "self delta normalanglerange directiondelta"
    )
    computeValidGrasps = refusing(
        "GraspingModel.computeValidGrasps",
        GRASPS,
        "self startindex checkcollision checkik checkgrasper backupdist returnnum",
    )
    drawContacts = refusing("drawContacts", GRASPS, "self contacts conelength transparency")
    generatepcg = refusing(
        "GraspingModel.generatepcg",
        GRASPS,
        "self preshapes standoffs rolls approachrays graspingnoise forceclosure "
        "forceclosurethreshold checkgraspfn manipulatordirections "
        "translationstepmult finestep friction avoidlinks plannername boxdelta "
        "spheredelta normalanglerange",
    )
    getGlobalApproachDir = refusing("getGlobalApproachDir", GRASPS, "self grasp")
    getGlobalGraspTransform = refusing("getGlobalGraspTransform", GRASPS, "self grasp collisionfree")
    getPreshape = refusing("getPreshape", GRASPS, "self grasp")
    init = refusing("init", GRASPS, "self friction avoidlinks plannername")
    moveToPreshape = refusing("moveToPreshape", GRASPS, "self grasp execute outputtraj outputtrajobj")
    runGrasp = refusing(
        "runGrasp", GRASPS, "self grasp graspingnoise translate forceclosure translationstepmult finestep"
    )
    runGraspFromTrans = refusing("runGraspFromTrans", GRASPS, "self grasp finestep")
    setFinalFingerValues = refusing("setFinalFingerValues", GRASPS, "self grasp")
    setPreshape = refusing("setPreshape", GRASPS, "self grasp")
    show = refusing("show", GRASPS, "self delay options forceclosure showcontacts")
    showgrasp = refusing("showgrasp", GRASPS, "self grasp collisionfree useik delay showfinal")
    testGrasp = refusing("testGrasp", GRASPS, "self graspingnoise Ngraspingtries forceclosurethreshold **named")
    validGraspIterator = refusing(
        "GraspingModel.validGraspIterator",
        GRASPS,
        "self startindex checkcollision checkik checkgrasper backupdist randomgrasps returnfinal",
    )


run = refusing("grasping.run", GRASPS, "*arguments **named")
