"""Campaigns: a study carried out on a rig, run by run, with nobody beside it."""

from server.studies.campaign.activity import Activity
from server.studies.campaign.campaign import Campaign, Outcome

__all__ = ["Activity", "Campaign", "Outcome"]
